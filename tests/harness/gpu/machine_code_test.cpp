// How textures are read, and loops, in a listing of machine code.

#include "harness/gpu/machine_code.h"

#include <gtest/gtest.h>

namespace shadowbench::gpu {
namespace {

records::ShaderFacts count(const char* listing) {
  records::ShaderFacts facts;
  count_reads(listing, facts);
  return facts;
}

TEST(MachineCode, ReadsAreOfTheirKind) {
  const records::ShaderFacts facts = count(
      "BB0:\n"
      "\timage_load v[0:3], v0, s[8:15] dmask:0xf unorm              ; f0001f00 00020000\n"
      "\timage_load_mip v[0:3], v[0:2], s[8:15] dmask:0xf            ; f0001f00 00020000\n"
      "\timage_sample v0, v[2:3], s[8:15], s[16:19] dmask:0x1         ; f0a00100 00820002\n"
      "\timage_sample_lz v0, v[2:3], s[8:15], s[16:19] dmask:0x1      ; f0a00100 00820002\n"
      "\timage_sample_l v0, v[2:3], s[8:15], s[16:19] dmask:0x1       ; f0a00100 00820002\n"
      "\timage_sample_c v0, v[2:3], s[8:15], s[16:19] dmask:0x1       ; f0a00100 00820002\n"
      "\timage_sample_c_lz_o v0, v[2:3], s[8:15], s[16:19] dmask:0x1  ; f0a00100 00820002\n"
      "\timage_gather4_c_lz v[0:3], v[2:4], s[8:15], s[16:19]         ; f0a00100 00820002\n"
      "\timage_gather4_lz v[0:3], v[2:4], s[8:15], s[16:19]           ; f0a00100 00820002\n"
      "\timage_gather4_cl v[0:3], v[2:4], s[8:15], s[16:19]           ; f0a00100 00820002\n"
      "\tbuffer_load_dword v0, off, s[0:3], 0                         ; e0500000 80000000\n"
      "\ts_endpgm                                                     ; bf810000\n");
  EXPECT_EQ(facts.loads, 2);
  EXPECT_EQ(facts.samples, 3);
  EXPECT_EQ(facts.compares, 2);
  EXPECT_EQ(facts.gathers, 3);
  EXPECT_EQ(facts.reads(), 10);
  EXPECT_EQ(facts.loops, 0);
}

TEST(MachineCode, ALoopIsABlockThatBranchesLeadBackTo) {
  const records::ShaderFacts facts = count(
      "BB0:\n\ts_cbranch_execz BB6   ; bf880013\n"
      "BB1:\n\tv_add_f32 v0, v1, v2  ; 00\n"
      "BB2:\n\ts_cbranch_scc1 BB1    ; bf85\n"
      "BB3:\n\ts_branch BB1          ; bf82\n"
      "BB4:\n\ts_cbranch_vccnz BB4   ; bf87\n"
      "BB6:\n\ts_endpgm              ; bf81\n");
  EXPECT_EQ(facts.loops, 2);  // two branches lead back to BB1, one to BB4, and one forward
}

TEST(MachineCode, TheCompilersLastStep_HasResultsFirstAndNamesTheHeadsOfLoops) {
  const records::ShaderFacts facts = count(
      "After Spilling:\nACO shader stage: fragment_fs\nBB0\n"
      "/* logical preds: / linear preds: / kind: uniform, top-level, loop-preheader, */\n"
      "\t v1: %12 = image_sample_c (kill)%5, (kill)%7,  v1: undef, (kill)%37 1d\n"
      "\t s2: %40 = p_branch BB1\nBB1\n"
      "/* logical preds: BB0, BB2, / linear preds: BB0, BB2, / kind: uniform, loop-header, */\n"
      "\t v4: %20,  v1: %21 = image_load %5, %6 2d\n"
      "\ts_cbranch_scc1 BB1\n"
      "\ts_endpgm\n");
  EXPECT_EQ(facts.compares, 1);
  EXPECT_EQ(facts.loads, 1);
  EXPECT_EQ(facts.loops, 1);
}

TEST(MachineCode, NothingIsNothing) { EXPECT_EQ(count(""), records::ShaderFacts()); }

}  // namespace
}  // namespace shadowbench::gpu
