// A Vulkan driver that ends the process that loads it, as a broken one may.

#include <csignal>

extern "C" [[gnu::visibility("default")]] void* vk_icdGetInstanceProcAddr(void*, const char*) {
  std::raise(SIGSEGV);
  return nullptr;
}
