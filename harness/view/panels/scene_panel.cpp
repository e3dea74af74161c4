#include "harness/view/panels/scene_panel.h"

#include <imgui.h>

#include <algorithm>

#include "base/error.h"
#include "harness/scene/load.h"

namespace shadowbench::view {

ScenePanel::ScenePanel(Workbench& bench, Widgets widgets) : bench_(bench), widgets_(widgets) {
  const options::Resources& resources = bench.state().options.resources;
  for (const auto& scenes : {scene::list_scenes(resources.scenes), scene::list_teaching_scenes(resources.scenes)})
    for (const scene::SceneInfo& info : scenes) scenes_.push_back(info.name);
  const std::string& own = bench.state().scene_argument;
  if (std::ranges::count(scenes_, own) == 0) scenes_.insert(scenes_.begin(), own);
  lessons_ = read_lessons(resources.lessons);
}

const Lesson* ScenePanel::lay_out() {
  if (!ImGui::CollapsingHeader("Scene and lesson", ImGuiTreeNodeFlags_DefaultOpen)) return nullptr;
  choose_scene();
  std::vector<std::string> titles = {"none"};
  for (const Lesson& lesson : lessons_) titles.push_back(lesson.title);
  if (widgets_.choose("lesson", "lesson", titles, lesson_, "A fault, in a state that shows it.")) return start_lesson();
  return lesson_ == 0 ? nullptr : show_lesson();
}

void ScenePanel::choose_scene() {
  const ViewState& state = bench_.state();
  auto chosen = static_cast<std::size_t>(std::ranges::find(scenes_, state.scene_argument) - scenes_.begin());
  if (!widgets_.choose("scene", "scene", scenes_, chosen, state.scene.title)) return;
  try {
    bench_.show(make_view_state(state.options, scenes_[chosen], state.sides));
    lesson_ = 0;
  } catch (const Error& error) {
    bench_.say(error.what());
  }
}

const Lesson* ScenePanel::start_lesson() {
  is_instead_ = false;
  if (lesson_ == 0) return nullptr;
  const Lesson& lesson = lessons_[lesson_ - 1];
  try {
    bench_.show(make_lesson_state(lesson, bench_.state().options, bench_.catalogue()));
    return &lesson;
  } catch (const Error& error) {
    bench_.say(error.what());
    lesson_ = 0;
    return nullptr;
  }
}

/// The text, and what can be done.
const Lesson* ScenePanel::show_lesson() {
  const Lesson& lesson = lessons_[lesson_ - 1];
  ImGui::PushTextWrapPos();
  for (const std::string& sentence : lesson.sentences) ImGui::TextUnformatted(sentence.c_str());
  ImGui::PopTextWrapPos();
  if (!lesson.instead_title.empty() &&
      widgets_.tick("lesson.instead", lesson.instead_title, is_instead_, "What the lesson changes."))
    bench_.change(Changes::all(), [&](ViewSettings& settings) {
      set_shared(settings, is_instead_ ? lesson.instead : lesson.settings);
    });
  return widgets_.press("lesson.again", "begin this lesson again", "Sets all as the lesson has it.") ? start_lesson()
                                                                                                     : nullptr;
}

}  // namespace shadowbench::view
