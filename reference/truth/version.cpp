#include "reference/truth/version.h"

#include "reference/truth/embree.h"

namespace shadowbench::truth {

std::string truth_version() { return SHADOWBENCH_TRUTH_SOURCES " Embree " RTC_VERSION_STRING; }

}  // namespace shadowbench::truth
