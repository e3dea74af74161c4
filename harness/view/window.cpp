#include "harness/view/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "report/images/text.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::view {

ViewLog::ViewLog(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "w")) {
  if (file_) return;
  throw Error(ErrorKind::kOutput, fmt::format("the log cannot be written ({})", std::strerror(errno)), file.string());
}

void ViewLog::note_widget(const std::string& name, const glm::vec2& least, const glm::vec2& most) {
  if (is_on()) widgets_[name] = glm::vec4(least, most);
}

void ViewLog::end_frame(const Frame& frame) {
  if (!is_on()) return;
  nlohmann::json line = {{"event", "frame"}, {"t", frame.begun_s}, {"ms", frame.ms}, {"drawn", frame.drawn}};
  for (const auto& [name, value] : frame.numbers) line[name] = value;
  for (const auto& [name, text] : frame.texts) line[name] = text;
  if (widgets_ != written_) {
    for (const auto& [name, place] : widgets_) line["widgets"][name] = {place.x, place.y, place.z, place.w};
    written_ = widgets_;
  }
  widgets_.clear();
  fmt::print(file_.get(), "{}\n", line.dump());
  std::fflush(file_.get());
}

void ViewLog::note(double now_s, const std::string& event, const std::string& what) {
  if (!is_on()) return;
  fmt::print(file_.get(), "{}\n", nlohmann::json({{"event", event}, {"t", now_s}, {"what", what}}).dump());
  std::fflush(file_.get());
}

namespace {

constexpr float kTextPixels = 14.0f;
constexpr float kShareOfScreen = 0.96f;  ///< that a window takes at most: its frame needs the rest

float find_scale(GLFWwindow* window, float asked) {
  if (asked > 0.0f) return asked;
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window, &x, &y);
  return x > 0.0f ? x : 1.0f;
}

void set_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = style.FrameRounding = 3.0f;
  style.Colors[ImGuiCol_WindowBg].w = 1.0f;  // half-transparent panels cost a software rasteriser much
  style.ScaleAllSizes(scale);
}

}  // namespace

Window::Window(gl::GlfwContext& context, float scale)
    : window_(context.window()), scale_(find_scale(context.window(), scale)) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file is left where the program was started
  io.Fonts->AddFontFromFileTTF(images::font_file().c_str(), kTextPixels * scale_);
  set_style(scale_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, note_key);  // ImGui's own calls it
  if (ImGui_ImplGlfw_InitForOpenGL(window_, true) && ImGui_ImplOpenGL3_Init("#version 450")) return;
  throw Error(ErrorKind::kContext, "Dear ImGui cannot draw into this window");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

glm::ivec2 Window::find_room() {
  const gl::GlfwLibrary library;
  glm::ivec2 corner(0), room(0);
  if (GLFWmonitor* screen = glfwGetPrimaryMonitor())
    glfwGetMonitorWorkarea(screen, &corner.x, &corner.y, &room.x, &room.y);
  return glm::vec2(room) * kShareOfScreen;
}

void Window::set_title(const std::string& title) {
  if (std::exchange(title_, title) != title) glfwSetWindowTitle(window_, title.c_str());
}

bool Window::is_closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::wait(double seconds) {
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

void Window::note_key(GLFWwindow* window, int key, int, int action, int modifiers) {
  auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
  if (action == GLFW_PRESS && !ImGui::GetIO().WantTextInput)
    self->keys_.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0});
}

std::vector<Window::KeyPress> Window::take_keys() { return std::exchange(keys_, {}); }

bool Window::is_held(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }

glm::ivec2 Window::size() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

void Window::begin_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::end_frame(const std::function<void()>& look) {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  look();
  glfwSwapBuffers(window_);
}

}  // namespace shadowbench::view
