#include "reference/truth/version.h"

#include <embree3/rtcore.h>

namespace shadowbench::truth {

std::string truth_version() { return SHADOWBENCH_TRUTH_SOURCES " Embree " RTC_VERSION_STRING; }

}  // namespace shadowbench::truth
