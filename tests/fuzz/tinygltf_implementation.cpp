// tinygltf with the fuzzer's instrumentation, in place of Debian's library, which decodes the pictures all the same.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
