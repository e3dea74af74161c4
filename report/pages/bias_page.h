#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/bias_record.h"

namespace shadowbench::pages {

/// A filter with less acne than this, a pixel in a thousand, is said to have enough bias.
inline constexpr double kLittleAcne = 0.001;

/// The smallest swept factor at which a filter has less acne than kLittleAcne; nothing where there is none.
std::optional<double> find_enough(const records::BiasCurve& curve);

/// Names a factor: "0", "1/8", "4".
std::string name_factor(double factor);

/// Draws a mode's rates over the amount: acne solid, contact gap dashed, theory as a vertical line. What is absent is
/// left out, and said where a whole kind is. A filter's place in `filters` gives it its colour and its mark.
document::Chart make_bias_chart(const records::BiasModeRecord& mode, const std::vector<std::string>& filters);

/// Makes the page of `shadowbench bias`.
document::Page make_bias_page(const records::BiasSweepRecord& sweep);

/// Makes bias.csv (RFC 4180): one row per mode, filter and amount; what is absent is empty.
std::string make_bias_csv(const records::BiasSweepRecord& sweep);

/// The least bias without acne of each filter, in what engines call their settings, with how each was converted and
/// from which source. Maps of suns alone: under a lamp an engine's texel is no length.
document::Section make_engine_section(const records::BiasSweepRecord& sweep);

}  // namespace shadowbench::pages
