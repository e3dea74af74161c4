#include "harness/view/panels/times_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

namespace shadowbench::view {
namespace {

void show_history(const std::string& name, const TimeHistory& history) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name.c_str());
  ImGui::TableNextColumn();
  const auto median = history.median();
  ImGui::TextUnformatted(median ? fmt::format("{:.3f}", *median).c_str() : "-");
  ImGui::TableNextColumn();
  const std::vector<float>& values = history.values();
  const float most = values.empty() ? 1.0f : *std::ranges::max_element(values);
  ImGui::PushID(name.c_str());
  ImGui::PlotLines("##history", values.data(), static_cast<int>(values.size()), 0, nullptr, 0.0f, most,
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
        ImGui::Text("%s on %s: %.3g us a million receivers,\n  bound by %s; prefilter %.3g us", name, gpu.c_str(),
                    record.estimate->lookup_us, record.estimate->bound_by.c_str(), record.estimate->prefilter_us);
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
      if (times.prefilter.count() > 0) show_history(fmt::format("{} prefilter", name), times.prefilter);
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

}  // namespace shadowbench::view
