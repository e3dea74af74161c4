#pragma once

#include "report/document/blocks.h"
#include "report/records/bias_record.h"

namespace shadowbench::pages {

/// The least bias without acne of each filter, in what engines call their settings, with how each was converted and
/// from which source. Maps of suns alone: under a lamp an engine's texel is no length.
document::Section make_engine_section(const records::BiasSweepRecord& sweep);

}  // namespace shadowbench::pages
