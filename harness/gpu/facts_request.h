#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/gl/program.h"
#include "report/records/records.h"

namespace shadowbench::gpu {

/// A full-screen pass to compile: its fragment shader, and the OpenGL format that it draws into.
struct PassSource {
  gl::ShaderSource fragment;
  std::string format;  ///< "r32f"
};

/// What a process is to compile for one GPU.
struct FactsRequest {
  std::string family;           ///< what RADV calls the GPU's family
  std::filesystem::path cache;  ///< folder that keeps facts between runs; empty: none does
  std::vector<PassSource> passes;
};

/// The facts of one pass, or why there are none: Vulkan refuses its GLSL, or the driver does.
struct FactsAnswer {
  records::ShaderFacts facts;
  std::string refused;  ///< empty where there are facts
};

void write_request(const std::filesystem::path& file, const FactsRequest& request);

/// Compiles what a file asks for, or takes it from the cache, and appends one line per pass to `answers`, so that those
/// before a crash of the driver are kept.
/// Throws Error(kContext) where there is no compiler for the family, Error(kInput) for a file that is no request,
/// Error(kOutput) where the answers cannot be written.
void answer_request(const std::filesystem::path& request, const std::filesystem::path& answers);

/// Reads what a process wrote until it ended, be it in the middle; in the order of the request's passes.
std::vector<FactsAnswer> read_answers(const std::filesystem::path& answers);

/// Counts in a listing of AMD machine code how textures are read, and its loops: samples, compares, gathers, loads and
/// loops of `facts`. What a read is follows from its mnemonic: image_load, image_gather4*, image_sample*, of which
/// those with a part "c" compare. A branch to a block at or above its own ends a loop.
/// Mesa's own listing of its compiler's last step, which stands in where there is no disassembler, has results first
/// ("v1: %2 = image_load"), and names the heads of loops in comments.
/// Source: AMD, "RDNA 2" Instruction Set Architecture (2020), chapter 8.2; listings as LLVM's disassembler has them.
void count_reads(std::string_view listing, records::ShaderFacts& facts);

}  // namespace shadowbench::gpu
