// What a browser makes of a page's charts: they are drawn, no text lies over another, and both buttons save a file.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <regex>

#include "base/files.h"
#include "tests/report/document/example_page.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::document {
namespace {

using ::testing::HasSubstr;

// Runs in the page after its own script: <pre id="..."> elements hold what was found.
constexpr const char* kProbe = R"JS(<script>
const say = (id, text) => { const pre = document.createElement("pre"); pre.id = id; pre.textContent = text; document.body.append(pre); };
const all = (selector) => [...document.querySelectorAll(selector)];
const blobs = new Map(), makeUrl = URL.createObjectURL;
URL.createObjectURL = (blob) => { const url = makeUrl(blob); blobs.set(url, blob); return url; };
HTMLAnchorElement.prototype.click = function () {
  blobs.get(this.href).arrayBuffer().then((buffer) => say("saved-" + this.download,
    [...new Uint8Array(buffer)].map((byte) => byte.toString(16).padStart(2, "0")).join("")));
};
const overlaps = [];
for (const svg of all(".holder svg")) {
  const boxes = [...svg.querySelectorAll("text")].map((text) => [text.textContent, text.getBBox()]);
  const size = svg.viewBox.baseVal;
  boxes.forEach(([a, p], i) => {
    if (p.x < -1 || p.x + p.width > size.width + 1 || p.y < -1 || p.y + p.height > size.height + 1) overlaps.push(a + " leaves the chart");
    for (const [b, q] of boxes.slice(i + 1))
      if (p.x + 1 < q.x + q.width && q.x + 1 < p.x + p.width && p.y + 4 < q.y + q.height && q.y + 4 < p.y + p.height) overlaps.push(a + " over " + b);
  });
}
say("overlaps", overlaps.join("; ") || "none");
say("wide", String(document.documentElement.scrollWidth > window.innerWidth));
const opened = [];
window.shadowbench = { openCell: (key) => opened.push(key) };
const [svg] = all("#single .holder svg"), [mark] = svg.querySelectorAll("g path[transform]");
const box = mark.getBoundingClientRect();
const at = { bubbles: true, clientX: box.x + box.width / 2, clientY: box.y + box.height / 2 };
svg.dispatchEvent(new PointerEvent("pointermove", at));
say("tip", document.querySelector("#single .tip:not([hidden])")?.textContent);
svg.dispatchEvent(new PointerEvent("click", at));
say("opened", opened.join());
for (const select of all("#choice select")) {
  select.value = "1";
  select.dispatchEvent(new Event("change"));
}
for (const button of all("#choice button")) button.click();
const count = () => all("#single .holder svg path[transform]").length, before = count();
all("#single .key")[1].dispatchEvent(new MouseEvent("click"));
say("hidden", String(before - count()));
const fewer = count();
all("#single .key")[2].dispatchEvent(new MouseEvent("click"));
say("shown", String(count() - fewer));
</script></body>)JS";

std::string read_output(const std::string& command) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return output;
  char buffer[65536];
  while (const std::size_t size = fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, size);
  pclose(pipe);
  return output;
}

/// The page as the browser has it once its scripts have run, in a window of a width.
std::string open_in_browser(const std::filesystem::path& folder, int width) {
  std::string html = write_html(make_example_page());
  html.replace(html.find("</body>"), 7, kProbe);
  write_text_file(folder / "page.html", html);
  return read_output(
      "timeout 100 chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --virtual-time-budget=5000 --user-data-dir='" +
      (folder / "profile").string() + "' --window-size=" + std::to_string(width) + ",900 --dump-dom 'file://" +
      (folder / "page.html").string() + "' 2>/dev/null");
}

bool has_browser() { return std::system("chromium --version >/dev/null 2>&1") == 0; }

std::map<std::string, std::string> list_findings(const std::string& dom) {
  std::map<std::string, std::string> findings;
  for (std::size_t at = dom.find("<pre id=\""); at != std::string::npos; at = dom.find("<pre id=\"", at + 1)) {
    const std::size_t id = at + 9, id_end = dom.find('"', id), text = id_end + 2;
    findings[dom.substr(id, id_end - id)] = dom.substr(text, dom.find("</pre>", text) - text);
  }
  return findings;
}

std::string decode_hex(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes += static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16));
  return bytes;
}

class Charts : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!has_browser()) GTEST_SKIP() << "chromium is not installed";
  }

  /// The page in a window of this test's width; the browser opens it once for all tests. On a busy machine its clock,
  /// which does not wait for what is packed beside the page, runs out before the PNG is there: then it opens it again.
  static const std::string& dom() {
    constexpr int kMostTries = 4;
    static std::map<int, std::string> opened;
    std::string& found = opened[GetParam()];
    for (int i = 0; i < kMostTries && found.find("<pre id=\"saved-example.d.png\">89504e47") == found.npos; ++i) {
      const records::TemporaryFolder folder("charts_" + std::to_string(GetParam()));
      found = open_in_browser(folder.path(), GetParam());
    }
    return found;
  }
};

TEST_P(Charts, AreDrawn_AndAnswerToThePointer) {
  auto found = list_findings(dom());
  EXPECT_EQ(found["overlaps"], "none");
  EXPECT_EQ(found["wide"], "false");
  EXPECT_EQ(found["tip"], "a detail &amp; more 0");
  EXPECT_EQ(found["opened"], "0123456789abcdef");
  EXPECT_EQ(found["hidden"], "12");  // the series, and the untitled one after it
  EXPECT_EQ(found["shown"], "1");    // the series that is hidden until then
  for (const char* text : {">0.05</text>", ">time of the lookup, ms</text>", ">vsm &lt;b&gt;</text>", ">label 1</text>",
                           "stroke-dasharray=\"6 4\"", "stroke-dasharray=\"2 3\""})
    EXPECT_THAT(dom(), HasSubstr(text));
}

TEST_P(Charts, AreSaved_AsSvgAndAsPng) {
  const records::TemporaryFolder folder("saved_" + std::to_string(GetParam()));
  auto found = list_findings(dom());
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(decode_hex(found["saved-example.d.svg"]).c_str()));
  EXPECT_STREQ(svg.first_child().name(), "svg");
  EXPECT_EQ(svg.first_child().attribute("width").as_int(), 1120);
  EXPECT_STREQ(svg.select_node("//text").node().text().get(), "Cost & error of <all> filters");
  EXPECT_GT(svg.select_nodes("//path[@transform]").size(), 12u);
  const std::filesystem::path png = folder.path() / "a.png";
  write_text_file(png, decode_hex(found["saved-example.d.png"]));
  const auto image = OIIO::ImageInput::open(png.string());
  ASSERT_TRUE(image);
  EXPECT_STREQ(image->format_name(), "png");
  EXPECT_EQ(image->spec().width, 2240);
  std::vector<unsigned char> pixels(static_cast<std::size_t>(image->spec().image_pixels()) *
                                    static_cast<std::size_t>(image->spec().nchannels));
  ASSERT_TRUE(image->read_image(0, 0, 0, image->spec().nchannels, OIIO::TypeDesc::UINT8, pixels.data()));
  EXPECT_LT(std::ranges::count(pixels, 255), static_cast<long>(pixels.size()));  // not a white sheet
  EXPECT_EQ(pixels.front(), 255);
}

INSTANTIATE_TEST_SUITE_P(DesktopAndPhone, Charts, ::testing::Values(1400, 390));

}  // namespace
}  // namespace shadowbench::document
