#pragma once

#include "harness/options/options.h"

namespace shadowbench::test {

/// Says nothing of a run's progress.
class Silent final : public options::Progress {
  void begin(int, int) override {}
  void show(int, const std::string&) override {}
  void note(const std::string&) override {}
};

}  // namespace shadowbench::test
