#pragma once

#include <string>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/bias_record.h"

namespace shadowbench::pages {

/// Names a factor: "0", "1/8", "4".
std::string name_factor(double factor);

/// Draws for each mode that takes an amount its rates over the amount: acne solid, contact gap dashed, theory as a
/// vertical line. What is absent is left out. A filter has the same colour and mark in all. `prefix`: of ids, which a
/// page has once.
document::ChartChoice make_bias_charts(const records::BiasSweepRecord& sweep, const std::string& prefix = {});

/// Recommends a bias for each filter under each light that has an answer: of the modes that leave less acne than
/// a pixel in a thousand, at the least amount swept that does, the one with the smallest contact gap; of equal ones the
/// first.
std::vector<records::BiasCell> recommend_biases(const std::vector<records::BiasSweepRecord>& sweeps);

/// Says it in a line: "constant:depth=0.002, contact gap 1.2 %".
std::string describe_bias(const records::BiasCell& recommended);

/// Makes the page of `shadowbench bias`. Requires the lights of one scene, one at least.
document::Page make_bias_page(const std::string& title, const std::vector<records::BiasSweepRecord>& sweeps);

/// The least bias without acne of each filter, in what engines call their settings, with how each was converted and
/// from which source. Maps of suns alone: under a lamp an engine's texel is no length.
document::Details make_engine_details(const records::BiasSweepRecord& sweep);

}  // namespace shadowbench::pages
