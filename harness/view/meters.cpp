#include "harness/view/meters.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

#include "harness/gl/survey.h"
#include "harness/measure/timing.h"
#include "reference/metrics/error_stats.h"
#include "report/records/records.h"

namespace shadowbench::view {
namespace {

constexpr double kSecondsBeforeError = 0.1;
constexpr std::size_t kRoundsOfADrawing = 40;

}  // namespace

void ErrorMeter::step(double now_s) {
  if (drawing_ != bench_.drawings()) {
    drawing_ = bench_.drawings();
    since_s_ = now_s;
    is_measured_ = false;
    rmse_ = {};
  }
  const MeasuredSides* truth = bench_.truth();
  if (is_measured_ || truth == nullptr || truth->truth.empty() || now_s - since_s_ < kSecondsBeforeError) return;
  is_measured_ = true;
  const std::vector<std::uint8_t> mask(truth->truth_mask.texels.begin(), truth->truth_mask.texels.end());
  for (std::size_t side = 0; side < kSides; ++side) {
    if (bench_.stage().passes(side) == nullptr) continue;
    const gl::Texture& drawn = bench_.stage().visibility(side, {0, bench_.state().options.width});
    const images::Image visibility = render::read_image(drawn, 1);
    if (const auto error = metrics::measure_error(visibility.texels, truth->truth.texels, mask))
      rmse_[side] = error->rmse;
  }
}

std::string ErrorMeter::describe(std::size_t side) const {
  if (bench_.state().sides[side].truth) return {};
  if (rmse_[side]) return fmt::format("RMSE {:.4f}", *rmse_[side]);
  const std::string missing = bench_.explain_no_truth();
  if (bench_.is_traced() && !missing.empty()) return "no RMSE: " + missing;
  return missing.empty() ? "RMSE ..." : fmt::format("RMSE ... ({})", missing);
}

namespace {

void show_history(const std::string& name, const TimeHistory& history) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name.c_str());
  ImGui::TableNextColumn();
  const bool is_timed = !history.empty();
  ImGui::TextUnformatted(
      is_timed ? fmt::format("{:.3f}", measure::summarise({history.begin(), history.end()}).median).c_str() : "-");
  ImGui::TableNextColumn();
  ImGui::PushID(name.c_str());
  ImGui::PlotLines("##history", history.data(), static_cast<int>(history.size()), 0, nullptr, 0.0f,
                   is_timed ? std::ranges::max(history) : 1.0f,
                   {ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight()});
  ImGui::PopID();
}

/// What the open compiler says of GPUs that are not there; known once both sides were measured.
void show_gpus(const Workbench& bench) {
  for (std::size_t side = 0; side < kSides; ++side) {
    const measure::MeasuredCell* cell = bench.find_measured(side);
    if (cell == nullptr || !cell->record.gpu) continue;
    for (const auto& [gpu, record] : *cell->record.gpu) {
      const char* name = kSideNames[side];
      if (record.estimate)
        ImGui::Text("%s on %s: %.3g ms of a frame of %dx%d, static light;\n  moving %.3g ms; bound by %s", name,
                    gpu.c_str(), records::frame_ms(*record.estimate, false), records::kGpuFrameWidth,
                    records::kGpuFrameHeight, records::frame_ms(*record.estimate, true),
                    record.estimate->bound_by.c_str());
      if (!record.facts.empty())
        ImGui::TextDisabled("  lookup: %d instructions, %d registers", record.facts.front().facts.instructions,
                            record.facts.front().facts.vector_registers);
    }
  }
}

}  // namespace

void show_times(const Workbench& bench, const TimeMeter& meter) {
  if (!ImGui::CollapsingHeader("Times", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (ImGui::BeginTable("times", 3)) {
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch, 2.2f);
    ImGui::TableSetupColumn("ms", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("history", ImGuiTableColumnFlags_WidthStretch, 1.6f);
    ImGui::TableHeadersRow();
    show_history("map", meter.map());
    for (std::size_t side = 0; side < kSides; ++side) {
      const Side& shown = bench.state().sides[side];
      if (shown.truth) continue;
      const char* name = kSideNames[side];
      const TimeMeter::Side& times = meter.side(side);
      if (!times.prefilter.empty()) show_history(fmt::format("{} prefilter", name), times.prefilter);
      show_history(fmt::format("{} filter alone", name), times.filter);
      show_history(fmt::format("{} lookup", name), times.lookup);
    }
    ImGui::EndTable();
  }
  show_gpus(bench);
  ImGui::PushTextWrapPos();
  ImGui::TextDisabled("%s", bench.is_busy() ? "Times wait until the truth is traced and the run is finished."
                                            : "Medians, while nothing moves. Filter alone: less an empty lookup.");
  ImGui::PopTextWrapPos();
}

bool TimeMeter::step() {
  if (drawing_ != bench_.drawings()) {
    drawing_ = bench_.drawings();
    rounds_ = 0;
    round_.clear();
    map_.clear();
    sides_ = {};
  }
  if (bench_.is_busy() || rounds_ == kRoundsOfADrawing) return false;
  if (round_.empty()) plan_round();
  const std::function<void()> pass = std::move(round_.back());
  round_.pop_back();
  pass();
  if (round_.empty()) ++rounds_;
  return rounds_ < kRoundsOfADrawing;
}

void TimeMeter::plan_round() {
  round_.emplace_back([this] { map_.push_back(time([this] { bench_.stage().redraw_map(bench_.state()); })); });
  for (std::size_t side = 0; side < kSides; ++side)
    if (bench_.stage().passes(side) != nullptr) plan_side(side, round_);
  std::reverse(round_.begin(), round_.end());
}

void TimeMeter::plan_side(std::size_t side, std::vector<std::function<void()>>& round) {
  Stage& stage = bench_.stage();
  Side& times = sides_[side];
  if (stage.passes(side)->has_prefilter()) {
    round.emplace_back(
        [&, side] { times.prefilter.push_back(time([&] { stage.passes(side)->prefilter(stage.light_map().map); })); });
    for (int i = 0; i < measure::kSettlingLookups; ++i)
      round.emplace_back([&, side] { time([&] { stage.look_up(side); }); });
  }
  round.emplace_back([&, side] { times.lookup.push_back(lookup_ms_ = time([&] { stage.look_up(side); })); });
  round.emplace_back([&, side] { times.filter.push_back(lookup_ms_ - time([&] { stage.look_up_nothing(side); })); });
}

float TimeMeter::time(const std::function<void()>& work) const {
  return static_cast<float>(gl::time_ms(bench_.renderer().timer, work));
}

}  // namespace shadowbench::view
