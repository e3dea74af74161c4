#pragma once

#include <gtest/gtest.h>

#include <string>

#include "harness/options/options.h"
#include "harness/stress/axis.h"
#include "tests/harness/measure/stand.h"

namespace shadowbench::stress {

/// Makes a inputs of these filters without a GL.
inline AxisInputs make_inputs(const std::string& filters = "") {
  AxisInputs inputs;
  inputs.resources = options::find_resources();
  inputs.filters = filters::built_in().parse_requests(filters);
  return inputs;
}

/// The same with a GL.
inline AxisInputs make_gl_inputs(const std::string& filters) {
  AxisInputs inputs = make_inputs(filters);
  inputs.renderer = &test::shared_renderer();
  return inputs;
}

/// Expects every case of an axis that is observed at this level to keep to its theories, or to say why not where that
/// is allowed, and some theory to be there.
inline void expect_theories_met(const Axis& axis, const AxisInputs& inputs, Level level, bool may_be_explained) {
  int limits = 0;
  for (const Case& item : axis.make_cases(inputs)) {
    if (item.level != level) continue;
    const records::StressCase found = find_onsets(item, axis);
    EXPECT_EQ(found.not_available, "") << axis.id;
    for (const records::StressLimit& limit : compare(item, found, axis)) {
      const bool explained = may_be_explained && limit.agreement == records::StressAgreement::kExplained;
      EXPECT_TRUE(explained || limit.agreement == records::StressAgreement::kAgrees)
          << axis.id << " " << item.filter << " " << item.variant << ": theory " << limit.onset.value_or(-1.0)
          << ", measured " << limit.measured.value_or(-1.0);
      ++limits;
    }
  }
  EXPECT_GT(limits, 0) << axis.id;
}

}  // namespace shadowbench::stress
