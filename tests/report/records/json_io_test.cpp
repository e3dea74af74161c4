#include "report/records/json_io.h"

#include <chrono>
#include <nlohmann/json.hpp>

#include "reference/metrics/metric_table.h"
#include "report/records/json_values.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;
using JsonIo = FolderTest;

// Says of each document whether the schema accepts it. Debian's python3-jsonschema decides; Python starts
// slowly, so one process judges all.
std::vector<bool> judge_all(const std::vector<json>& documents, const std::filesystem::path& schema) {
  const std::filesystem::path dir = schema.parent_path();
  constexpr const char* kJudge =
      "import json, jsonschema, sys\n"
      "schema = json.load(open(sys.argv[1]))\n"
      "judge = jsonschema.validators.validator_for(schema)(schema)\n"
      "judge.check_schema(schema)\n"
      "for line in open(sys.argv[2]): print(judge.is_valid(json.loads(line)))\n";
  std::string lines;
  for (const json& document : documents) lines += document.dump() + "\n";
  write_text_file(dir / "documents", lines);
  write_text_file(dir / "judge.py", kJudge);
  const std::string command =
      "cd '" + dir.string() + "' && /usr/bin/python3 judge.py '" + schema.string() + "' documents > verdicts";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<bool> verdicts;
  std::istringstream text(read_text(dir / "verdicts"));
  for (std::string line; std::getline(text, line);) verdicts.push_back(line == "True");
  return verdicts;
}

bool is_valid(const std::filesystem::path& file, const std::filesystem::path& schema) {
  return judge_all({json::parse(read_text(file))}, schema) == std::vector{true};
}

CellRecord make_timed_out_cell() {
  CellRecord cell = make_cell("cubes", "esm", 1.0);
  cell.status = CellStatus::kTimeout;
  cell.message = "no answer after 10 s";
  cell.time_ms = {};
  cell.ratio_to_none = {};
  cell.images = {};
  return cell;
}

// No two fields alike.
constexpr ShaderFacts kFacts{31, 168, 8, 128, 1, 2, 16, 779, 49, 3, 4, 5, 6, 7};

// Gives each metric that a cell lacks a number within its range.
void fill_metrics(CellRecord& cell) {
  int place = 0;
  for (const metrics::Metric& metric : metrics::metric_table())
    metrics::visit_metric(metric, cell, [&](const std::string&, auto& value) {
      ++place;
      if (value) return;
      if constexpr (std::is_same_v<decltype(value), std::optional<double>&>)
        value = place / 128.0;
      else
        value = place;
    });
}

// A cell that lacks nothing.
CellRecord make_full_cell() {
  CellRecord cell = make_cell("cubes", "full", 4.0);
  cell.kernel_radius_texels = 4.0;
  cell.kernel = {1.9, "soft"};
  cell.teaching = false;
  cell.claims = {"contact-hardening"};
  cell.bias = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 0.7, 0.8, {0.0, 0.9, 1.0}, true, 1.1, 1.2, true, true};
  cell.time_ms.prefilter = Quartiles{1.5, 1.25, 1.75, 3};
  cell.ratio_to_none.static_light = Ratio{1.5, {1.25, 1.75}};
  cell.ratio_to_none.moving = Ratio{2.5, {2.25, 2.75}};
  cell.range = {filters::Border::kEdge, false, false};
  cell.attribution.estimator.share = -0.1;
  cell.images = {"a.png", "b.png", "c.png", "d.png", "e.exr", "g.png", "all.png",
                 "i.png", "j.js",  "k.png", "l.js",  "m.js",  "vsm",   TileRecord{1, 2, 3, 4},
                 "n.png", "o.png", 16};
  fill_metrics(cell);
  cell.fit = "view snapped";
  cell.light = "120,-35.5";
  cell.time_ms.stopped = "budget";
  cell.phases = 4;
  cell.rmse_ci95 = Interval{0.09, 0.11};
  cell.rmse_replicates = {0.095, 0.1, 0.105};
  cell.flicker_ci95 = Interval{0.03, 0.06};
  cell.time_ms.empty = Quartiles{1.0, 0.5, 1.5, 3};
  cell.time_ms.static_light = OwnTime{{-0.25, -0.5, 0.5, 3}, {-0.5, 0.5}};
  cell.time_ms.moving = OwnTime{{4.0, 3.5, 4.5, 3}, {3.5, 4.5}};
  cell.gpu = {{"navi21",
               {{{"lookup", 1, kFacts}, {"blur", 2, {}}},
                GpuEstimateRecord{.lookup_us = 6.5,
                                  .prefilter_us = 3.0,
                                  .map_us = 0.5,
                                  .arithmetic_us = 1.0,
                                  .sampling_us = 6.5,
                                  .memory_us = 2.0,
                                  .bound_by = "memory"},
                ""}},
              {"vega10", {{}, std::nullopt, "no driver"}}};
  cell.content = "0123";
  cell.machine = {"A CPU", 3, "A GPU", false, TimerKind::kTimerQuery};
  cell.measured_s = 1.25;
  cell.warnings = {"one", "two"};
  cell.absent.clear();
  return cell;
}

std::string message_of(const std::function<void()>& action) {
  const Error error = error_of(action);
  EXPECT_EQ(error.kind() == ErrorKind::kInput, error.message() != "no error");
  return error.what();
}

TEST_F(JsonIo, Cell_ComesBackAsItWas) {
  for (const CellRecord& cell : {make_cell("cubes", "vsm", 4.5), make_timed_out_cell(), make_full_cell()}) {
    const json written = to_json(cell);
    EXPECT_EQ(to_json(cell_from_json(written, "here")), written);
  }
}

TEST_F(JsonIo, FilesOfACell_AreAllThatItNames) {
  CellRecord cell = make_full_cell();
  cell.accumulation.emplace().picture = "frames.png";
  const std::vector<std::string> files = list_files(cell);
  EXPECT_EQ(files.size(), 15u);
  for (const auto& file : {cell.images.grid, cell.images.frames, cell.images.all_lights, cell.accumulation->picture})
    EXPECT_THAT(files, Contains(file.value()));
  EXPECT_THAT(files, Not(Contains(cell.images.parts.value())));
}

TEST_F(JsonIo, FullCell_HasNoNull) { EXPECT_EQ(to_json(make_full_cell()).at("absent"), json::object()); }

// Expects that reading a cell refuses the lack of exactly what the schema requires of this object in it.
void expect_required(const json& schema, const json::json_pointer& place) {
  const json required = schema.value("required", json::array());
  for (const auto& [name, property] : schema.at("properties").items()) {
    json written = to_json(make_full_cell());
    written[place].erase(name);
    const bool is_required = std::find(required.begin(), required.end(), name) != required.end();
    EXPECT_THAT(message_of([&] { cell_from_json(written, "here"); }),
                HasSubstr(is_required ? "is missing" : "no error"))
        << place / name;
    if (property.contains("properties")) expect_required(property, place / name);
  }
}

TEST_F(JsonIo, ReadingRequires_WhatTheSchemaDoes) {
  expect_required(json::parse(results_schema()).at("$defs").at("cell"), json::json_pointer());
}

TEST_F(JsonIo, NotFinite_IsNullWithItsReason) {
  CellRecord cell = make_cell("cubes", "vsm", 4.0);
  cell.cost.fetches = std::numeric_limits<double>::quiet_NaN();
  cell.time_ms.lookup->q3 = std::numeric_limits<double>::infinity();
  const json written = to_json(cell);
  EXPECT_TRUE(written.at("cost").at("fetches").is_null());
  EXPECT_TRUE(written.at("time_ms").at("lookup").is_null());
  EXPECT_EQ(written.at("absent").at("cost.fetches"), "the value was not finite");
  EXPECT_EQ(written.at("absent").at("time_ms.lookup"), "the value was not finite");
}

void expect_explained(const json& value, const std::string& path, const json& absent) {
  const std::string group = path.substr(0, path.find('.'));
  const std::string middle = path.substr(0, path.rfind('.'));
  if (value.is_null())
    EXPECT_TRUE(absent.contains(path) || absent.contains(group) || absent.contains(middle)) << path;
  else if (value.is_object())
    for (const auto& [name, child] : value.items())
      expect_explained(child, path.empty() ? name : path + "." + name, absent);
}

TEST_F(JsonIo, EveryNull_HasAReason) {
  for (const CellRecord& cell : {make_cell("cubes", "vsm", 4.5), make_timed_out_cell(), CellRecord{}}) {
    const json written = to_json(cell);
    expect_explained(written, "", written.at("absent"));
  }
  const json absent = to_json(make_cell("cubes", "vsm", 4.5)).at("absent");
  EXPECT_EQ(absent.at("error"), "no truth in this run");
  EXPECT_EQ(absent.at("artefact"), "not measured");
  EXPECT_EQ(absent.at("cost.prefilter_texels"), "not measured");
  EXPECT_FALSE(absent.contains("cost"));
}

TEST_F(JsonIo, WhatWasMeasuredAfterReadingAgain_IsNoLongerAbsent) {
  CellRecord cell = make_full_cell();
  cell.error = {};
  cell.rmse_ci95.reset();
  cell.rmse_replicates.reset();
  cell.flicker_ci95.reset();
  cell.truth = {};
  CellRecord again = cell_from_json(to_json(cell), "test");
  ASSERT_EQ(again.absent.at("error"), "not measured");
  again.error.rmse = 0.5;
  const json absent = to_json(again).at("absent");
  EXPECT_FALSE(absent.contains("error"));
  EXPECT_EQ(absent.at("error.mae"), "not measured");
  EXPECT_EQ(absent.at("truth"), "not measured");
}

TEST_F(JsonIo, TextThatIsNotUtf8_IsWrittenAllTheSame) {
  CellRecord cell = make_cell("bad\xff", "vsm", 4.0);
  write_cell(folder_.path(), cell);
  EXPECT_EQ(read_cell(folder_.path(), cell.key).scene, "bad\xEF\xBF\xBD");
}

TEST_F(JsonIo, Results_AreValidAgainstTheirSchema) {
  RunRecord run = make_run();
  run.warnings = {"a \"warning\""};
  run.machine.load_at_start = std::nullopt;
  write_results(folder_.path(), run, {make_cell("cubes", "vsm", 4.5), make_timed_out_cell(), make_full_cell()});
  EXPECT_TRUE(is_valid(folder_.path() / "results.json", folder_.path() / "results.schema.json"));
  EXPECT_EQ(read_text(folder_.path() / "results.schema.json"), results_schema());
  write_results(folder_.path(), make_run(), {});
  EXPECT_TRUE(is_valid(folder_.path() / "results.json", folder_.path() / "results.schema.json"));
  EXPECT_TRUE(read_results(folder_.path() / "results.json").cells.empty());
}

TEST_F(JsonIo, CellFile_IsValidAgainstItsPartOfTheSchema) {
  const CellRecord cell = make_cell("cubes", "vsm", 4.5);
  write_cell(folder_.path(), cell);
  json schema = json::parse(results_schema());
  schema = {{"$schema", schema["$schema"]}, {"$ref", "#/$defs/cell_file"}, {"$defs", schema["$defs"]}};
  write_text_file(folder_.path() / "schema.json", schema.dump());
  EXPECT_TRUE(is_valid(cell_path(folder_.path(), cell.key), folder_.path() / "schema.json"));
}

// One broken results.json per line: each must be refused by the schema.
TEST_F(JsonIo, BrokenRecords_AreRefusedByTheSchema) {
  write_results(folder_.path(), make_run(), {make_cell("cubes", "vsm", 4.5)});
  const json good = json::parse(read_text(folder_.path() / "results.json"));
  const std::vector<json> patches = {
      json::parse(R"([{"op": "remove", "path": "/cells/0/time_ms/map"}])"),
      json::parse(R"([{"op": "add", "path": "/cells/0/extra", "value": 1}])"),
      json::parse(R"([{"op": "add", "path": "/cells/0/error/extra", "value": 1}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/time_ms/lookup/n", "value": "9"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/status", "value": "fine"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/status", "value": "timeout"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/params/radius", "value": null}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/key", "value": "../../x"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/images/picture", "value": "/etc/passwd"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/images/values", "value": "/etc/passwd"}])"),
      json::parse(R"([{"op": "remove", "path": "/cells/0/images/stability"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/map_format", "value": "d8"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/fit", "value": "box"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/light", "value": "noon"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/coverage/map_used", "value": 2}])"),
      json::parse(R"([{"op": "remove", "path": "/cells/0/map_size"}])"),
      json::parse(R"([{"op": "remove", "path": "/cells/0/images/texel_density"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/range/border", "value": "mirror"}])"),
      json::parse(R"([{"op": "replace", "path": "/cells/0/range/far_test", "value": "on"}])"),
      json::parse(R"([{"op": "remove", "path": "/cells/0/range/behind_test"}])"),
      json::parse(R"([{"op": "add", "path": "/cells/0/machine", "value": {"cpu": "x", "cores": 2}}])"),
      json::parse(R"([{"op": "remove", "path": "/work/truths_cached"}])"),
      json::parse(R"([{"op": "replace", "path": "/work/truths_traced", "value": -1}])"),
      json::parse(R"([{"op": "replace", "path": "/schema_version", "value": 1}])"),
      json::parse(R"([{"op": "add", "path": "/extra", "value": 1}])"),
      json::parse(R"([{"op": "remove", "path": "/gl/timer"}])"),
      json::parse(R"([{"op": "add", "path": "/gl/extra", "value": 1}])"),
  };
  std::vector<json> documents = {good};
  for (const json& patch : patches) documents.push_back(good.patch(patch));
  const std::vector<bool> verdicts = judge_all(documents, folder_.path() / "results.schema.json");
  ASSERT_EQ(verdicts.size(), documents.size());
  EXPECT_TRUE(verdicts[0]);
  for (std::size_t i = 0; i < patches.size(); ++i) EXPECT_FALSE(verdicts[i + 1]) << patches[i];
}

TEST_F(JsonIo, Results_HoldTheCellsInTheGivenOrder) {
  write_results(folder_.path(), make_run(), {make_cell("cubes", "vsm", 5.0), make_cell("cubes", "none", 4.0)});
  const Results results = read_results(folder_.path() / "results.json");
  ASSERT_EQ(results.cells.size(), 2u);
  EXPECT_EQ(results.cells[0].filter, "vsm");
  EXPECT_EQ(results.cells[1].filter, "none");
  EXPECT_EQ(to_json(results.run), to_json(make_run()));
}

TEST_F(JsonIo, CutOffFile_IsAnInputErrorThatNamesItAndSaysWhatToDo) {
  const CellRecord cell = make_cell("cubes", "vsm", 4.5);
  write_cell(folder_.path(), cell);
  const std::string whole = read_text(cell_path(folder_.path(), cell.key));
  write_text_file(cell_path(folder_.path(), cell.key), whole.substr(0, whole.size() / 2));
  const std::string message = message_of([&] { read_cell(folder_.path(), cell.key); });
  EXPECT_THAT(message, HasSubstr(cell_path(folder_.path(), cell.key).string()));
  EXPECT_THAT(message, HasSubstr("cut off"));
  EXPECT_THAT(message, HasSubstr("delete this file and run again"));
}

TEST_F(JsonIo, OtherSchemaVersion_IsAnInputError) {
  write_text_file(folder_.path() / "results.json", R"({"schema_version": 99})");
  EXPECT_THAT(message_of([&] { read_results(folder_.path() / "results.json"); }),
              HasSubstr(fmt::format("schema_version is 99, and this program reads {}", kSchemaVersion)));
  write_text_file(folder_.path() / "results.json", "[]");
  EXPECT_THAT(message_of([&] { read_results(folder_.path() / "results.json"); }), HasSubstr("is missing"));
}

TEST_F(JsonIo, CellsThatAreNone_AreRefused_OnceTheFileIsKnownToBeWhole) {
  const std::filesystem::path file = folder_.path() / "results.json";
  write_results(folder_.path(), make_run(), {make_cell("cubes", "vsm", 4.5)});
  const json good = json::parse(read_text(file));
  const auto refuse = [&](const std::string& text) {
    write_text_file(file, text);
    return message_of([&] { read_results(file); });
  };
  json bad = good;
  bad["cells"].push_back(5);
  EXPECT_THAT(refuse(bad.dump()), HasSubstr("'key' is missing"));
  bad["cells"][1] = {{"key", 5}};
  EXPECT_THAT(refuse(bad.dump()), HasSubstr("'key' holds 5"));
  EXPECT_THAT(refuse(bad.dump().substr(0, bad.dump().size() - 1)), HasSubstr("cut off"));
  bad["cells"] = {{"0", good["cells"][0]}};
  EXPECT_THAT(refuse(bad.dump()), HasSubstr("the list 'cells' is missing"));
  bad.erase("cells");
  EXPECT_THAT(refuse(bad.dump()), HasSubstr("the list 'cells' is missing"));
}

TEST_F(JsonIo, CellThatStandsTwice_IsRefused) {
  const CellRecord cell = make_cell("cubes", "vsm", 4.5);
  write_results(folder_.path(), make_run(), {cell, make_cell("cubes", "esm", 4.5), cell});
  EXPECT_THAT(message_of([&] { read_results(folder_.path() / "results.json"); }), HasSubstr(cell.key));
}

/// Twice as many members took four times as long: these, half a minute.
TEST_F(JsonIo, ManyMembers_TakeTimeInProportion) {
  std::string text = "{";
  for (int i = 0; i < 60000; ++i) text += fmt::format("\"{}\": {{\"a\": {{}}}},", i);
  write_text_file(folder_.path() / "many.json", text + "\"last\": 0}");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(read_json_file(folder_.path() / "many.json", kMebibyte * 64, "").size(), 60001u);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(JsonIo, MissingFile_IsAnInputError) {
  EXPECT_THAT(message_of([] { read_results("/nowhere/results.json"); }), HasSubstr("/nowhere/results.json"));
}

TEST_F(JsonIo, FieldOfAnotherType_IsAnInputErrorThatNamesTheField) {
  json written = to_json(make_cell("cubes", "vsm", 4.5));
  written["cost"]["passes"] = 1.5;
  EXPECT_THAT(message_of([&] { cell_from_json(written, "f.json"); }), HasSubstr("f.json: the field 'cost.passes'"));
  written = to_json(make_cell("cubes", "vsm", 4.5));
  written["status"] = "fine";
  EXPECT_THAT(message_of([&] { cell_from_json(written, "f.json"); }), HasSubstr("'status'"));
  written.erase("status");
  EXPECT_THAT(message_of([&] { cell_from_json(written, "f.json"); }), HasSubstr("'status' is missing"));
  EXPECT_THAT(message_of([&] { cell_from_json(json(), "f.json"); }), HasSubstr("is missing"));
}

TEST_F(JsonIo, NestedWithoutEnd_IsAnInputError) {
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  write_text_file(folder_.path() / "results.json",
                  fmt::format(R"({{"schema_version": {}, "commit": {}}})", kSchemaVersion, deep));
  EXPECT_THAT(message_of([&] { read_results(folder_.path() / "results.json"); }),
              HasSubstr("nested more than 100 deep"));
  write_text_file(folder_.path() / "deep.json", deep);
  EXPECT_THAT(message_of([&] { read_json_file(folder_.path() / "deep.json", kMebibyte * 64, ""); }),
              HasSubstr("nested more than 100 deep"));
}

TEST_F(JsonIo, PathsAndKeysThatLeaveTheFolder_AreRefused) {
  for (const std::string& path :
       {std::string("../outside.png"), std::string("/etc/passwd"), std::string("images/../../x.png"), std::string(".."),
        std::string(), std::string("images/x.png\0/../..", 19)}) {
    json written = to_json(make_full_cell());
    written["images"]["picture"] = path;
    EXPECT_THAT(message_of([&] { cell_from_json(written, "f.json"); }), HasSubstr("'images.picture'")) << path;
  }
  json written = to_json(make_full_cell());
  written["key"] = "../../../../etc/x";
  EXPECT_THAT(message_of([&] { cell_from_json(written, "f.json"); }), HasSubstr("'key'"));
}

TEST_F(JsonIo, ShardThatCannotBe_IsRefused) {
  for (const auto& [field, value] : std::map<std::string, int>{{"shards", 0}, {"shard", 0}, {"cells", -1}}) {
    json written = to_json(make_run());
    written["experiment"][field] = value;
    EXPECT_THAT(message_of([&] { run_from_json(written, "f.json"); }), HasSubstr("'experiment'")) << field;
  }
}

}  // namespace
}  // namespace shadowbench::records
