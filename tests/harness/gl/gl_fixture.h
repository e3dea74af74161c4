#pragma once

#include <gtest/gtest.h>

#include "harness/gl/context/context.h"

namespace shadowbench::gl {

/// Gives each test a software context of its own, and fails it for any GL error that it leaves behind.
class GlTest : public ::testing::Test {
 protected:
  Context& context() { return *choice_.context; }

  void TearDown() override { EXPECT_NO_THROW(context().require_no_gl_errors()); }

 private:
  ContextChoice choice_ = create_context(Backend::kSoftware);
};

}  // namespace shadowbench::gl
