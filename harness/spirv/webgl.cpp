#include "harness/spirv/spirv.h"

#ifdef SHADOWBENCH_HAS_LIVE_PAGE
#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <memory>
#include <new>
#include <spirv-tools/optimizer.hpp>

#include "base/error.h"

namespace shadowbench::spirv {
namespace {

struct DestroyContext {
  void operator()(spvc_context context) const { spvc_context_destroy(context); }
};

using Context = std::unique_ptr<spvc_context_s, DestroyContext>;

Context make_context() {
  spvc_context context = nullptr;
  if (spvc_context_create(&context) != SPVC_SUCCESS) throw std::bad_alloc();
  return Context(context);
}

/// Goes on, or says what the library could not do.
void require(spvc_result result, const Context& context) {
  if (result == SPVC_SUCCESS) return;
  std::string message = spvc_context_get_last_error_string(context.get());
  message.resize(message.find_last_not_of(". \n") + 1);
  throw Error(ErrorKind::kFilter, fmt::format("WebGL 2 cannot have this GLSL: {}", message));
}

/// The source with WEBGL defined, on the line of `#version`'s end: other lines keep their numbers.
gl::ShaderSource define_webgl(gl::ShaderSource source) {
  const std::size_t end = source.text.find('\n');
  source.text.insert(end + 1, "#define WEBGL 1\n");
  return source;
}

/// Drops branches that constants decide: what WebGL 2 lacks does no harm where it is never reached.
void drop_dead_branches(std::vector<std::uint32_t>& words) {
  spvtools::Optimizer optimizer(SPV_ENV_OPENGL_4_5);
  optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
  optimizer.Run(words.data(), words.size(), &words);
}

}  // namespace

bool can_translate_to_webgl() { return true; }

std::string translate_to_webgl(const gl::ShaderSource& source, Stage stage) {
  Shader shader = compile(define_webgl(source), stage, Rules::kOpenGl);
  drop_dead_branches(shader.words);
  const Context context = make_context();
  spvc_parsed_ir parsed = nullptr;
  require(spvc_context_parse_spirv(context.get(), shader.words.data(), shader.words.size(), &parsed), context);
  spvc_compiler compiler = nullptr;
  require(spvc_context_create_compiler(context.get(), SPVC_BACKEND_GLSL, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                       &compiler),
          context);
  spvc_compiler_options options = nullptr;
  require(spvc_compiler_create_compiler_options(compiler, &options), context);
  const auto set = [&](spvc_compiler_option option, bool value) {
    require(spvc_compiler_options_set_bool(options, option, value ? SPVC_TRUE : SPVC_FALSE), context);
  };
  require(spvc_compiler_options_set_uint(options, SPVC_COMPILER_OPTION_GLSL_VERSION, 300), context);
  set(SPVC_COMPILER_OPTION_GLSL_ES, true);
  set(SPVC_COMPILER_OPTION_GLSL_ES_DEFAULT_FLOAT_PRECISION_HIGHP, true);
  set(SPVC_COMPILER_OPTION_FIXUP_DEPTH_CONVENTION, true);
  set(SPVC_COMPILER_OPTION_GLSL_ENABLE_420PACK_EXTENSION, false);
  require(spvc_compiler_install_compiler_options(compiler, options), context);
  const char* text = nullptr;
  require(spvc_compiler_compile(compiler, &text), context);
  return text;
}

}  // namespace shadowbench::spirv
#else

bool shadowbench::spirv::can_translate_to_webgl() { return false; }
std::string shadowbench::spirv::translate_to_webgl(const gl::ShaderSource&, Stage) { return {}; }
#endif
