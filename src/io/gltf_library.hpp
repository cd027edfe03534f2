// io/gltf_library.hpp: tinygltf, as it is used here: its structure of a file, and nothing else of it.
//
// No images, and no files: what it asks for comes through a callback of ours.  Under a name of its own, so that a program that is linked with
// libtoile may have another tinygltf.
#pragma once
#define tinygltf tinygltf_of_toile
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>
