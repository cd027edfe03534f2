// io/gltf_library.hpp: tinygltf as it is used here: only its parser and data structures.
//
// Without images and file access: files are read through a callback of ours.  In a namespace of its own, so that a program that links
// libtoile may have another tinygltf.
#pragma once
#define tinygltf tinygltf_of_toile
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>
