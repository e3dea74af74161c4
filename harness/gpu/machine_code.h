#pragma once

#include <string_view>

#include "report/records/records.h"

namespace shadowbench::gpu {

/// Counts in a listing of AMD machine code how textures are read, and its loops: samples, compares, gathers, loads and
/// loops of `facts`. What a read is follows from its mnemonic: image_load, image_gather4*, image_sample*, of which
/// those with a part "c" compare. A branch to a block at or above its own ends a loop.
/// Mesa's own listing of its compiler's last step, which stands in where there is no disassembler, has results first
/// ("v1: %2 = image_load"), and names the heads of loops in comments.
/// Source: AMD, "RDNA 2" Instruction Set Architecture (2020), chapter 8.2; listings as LLVM's disassembler has them.
void count_reads(std::string_view listing, records::ShaderFacts& facts);

}  // namespace shadowbench::gpu
