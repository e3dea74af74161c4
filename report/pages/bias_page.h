#pragma once

#include <string>
#include <vector>

#include "report/records/bias_record.h"

namespace shadowbench::pages {

/// The acne that words call none: a pixel in a thousand.
inline constexpr double kLittleAcne = 0.001;

/// Gives the smallest swept factor at which a filter has less than kLittleAcne; nothing where there is none.
std::optional<double> find_enough(const records::BiasCurve& curve);

/// Says of a mode, from its numbers: how much of the theoretical amount each filter needs, and what theory costs in
/// contact.
std::vector<std::string> describe_bias_mode(const records::BiasModeRecord& mode);

/// Makes bias.html: one page that opens from disk and loads nothing but the pictures that it names, by relative links.
std::string make_bias_html(const records::BiasSweepRecord& sweep);

/// Makes bias.csv (RFC 4180): one row per mode, filter and amount; what is absent is empty.
std::string make_bias_csv(const records::BiasSweepRecord& sweep);

}  // namespace shadowbench::pages
