#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/records/description.h"

namespace shadowbench::records {

/// How visibility fares that is accumulated over frames by one rule, in a view that stands still.
struct ResolveRecord {
  std::string rule;                          ///< "newest", "mean", "exponential" or "clamped"
  bool jitter = false;                       ///< the camera moved by parts of a pixel
  std::vector<double> rmse;                  ///< after each frame, against the truth
  std::optional<std::vector<double>> noise;  ///< after each frame, against what very many frames converge to
  std::optional<double> flicker;             ///< root mean square of its change from frame to frame, in the second half
};

/// How long a shadow lags behind that moved.
struct GhostRecord {
  double texels = 0.0;              ///< that it moved by in each frame
  std::string rule;                 ///< as ResolveRecord's
  std::int64_t pixels = 0;          ///< behind its edges
  std::optional<double> at_stop;    ///< mean error of these pixels in the last frame of the motion; nothing without any
  std::optional<int> frames_until;  ///< that the shadow then stood still, until it was within kGhostLimit of the truth
};
inline constexpr double kGhostLimit = 0.02;

/// What accumulation over frames makes of a filter.
struct AccumulationRecord {
  std::vector<ResolveRecord> resolves;
  std::vector<GhostRecord> ghosts;
  std::string no_ghosts;        ///< why there are none; empty where there are
  double exponential_ms = 0.0;  ///< of the pass that accumulates, which is in no other time
  double clamped_ms = 0.0;
  std::optional<std::string> picture;  ///< of all cells of the view, relative to the report folder
};

void visit_fields(Is<ResolveRecord> auto& resolve, auto&& visit) {
  visit("rule", resolve.rule, {.text = "newest: the last frame; mean: of all; exponential, clamped: of weight 0.1"});
  visit("jitter", resolve.jitter,
        {.text = "the camera moved by parts of a pixel, and the truth is the mean over them"});
  visit("rmse", resolve.rmse, {.text = "to the truth, after each frame"});
  visit("noise", resolve.noise, {.text = "RMS difference from what very many frames converge to", .may_lack = true});
  visit("flicker", resolve.flicker, {.text = "RMS change from frame to frame, in the second half", .may_lack = true});
}

void visit_fields(Is<GhostRecord> auto& ghost, auto&& visit) {
  visit("texels", ghost.texels, {.text = "that shadows moved by in each frame"});
  visit("rule", ghost.rule);
  visit("pixels", ghost.pixels, {.text = "dark before the motion and lit after it"});
  visit("at_stop", ghost.at_stop, {.text = "their mean error in the last frame of the motion", .may_lack = true});
  visit("frames_until", ghost.frames_until, {.text = "that error was 0.02 or less", .may_lack = true});
}

void visit_fields(Is<AccumulationRecord> auto& accumulation, auto&& visit) {
  visit("resolves", accumulation.resolves);
  visit("ghosts", accumulation.ghosts);
  visit("no_ghosts", accumulation.no_ghosts, {.text = "why there are none; empty where there are"});
  visit("exponential_ms", accumulation.exponential_ms, {.text = "the pass that accumulates; in no other time"});
  visit("clamped_ms", accumulation.clamped_ms);
  visit("picture", accumulation.picture, {.text = "relative to the report folder", .is_path = true, .may_lack = true});
}

}  // namespace shadowbench::records
