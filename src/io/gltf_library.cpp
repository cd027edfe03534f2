// io/gltf_library.cpp: tinygltf's own code.
#include <fstream>
#include <sstream>

#define TINYGLTF_IMPLEMENTATION
#include "io/gltf_library.hpp"
