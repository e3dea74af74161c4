#include "harness/engines/score_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "harness/engines/exported_scene.h"
#include "harness/measure/cell_analysis.h"
#include "harness/render/picture_passes.h"
#include "harness/run/float_images.h"
#include "harness/run/task_images.h"
#include "harness/run/worker_process.h"
#include "reference/metrics/error_stats.h"
#include "report/images/picture_io.h"
#include "report/pages/write_page.h"
#include "report/records/cell_key.h"

namespace shadowbench::engines {
namespace {

constexpr const char* kAnother = "another renderer drew it";
constexpr std::size_t kLongestName = 60;

/// A row of no filter: what it does not have is said.
records::CellRecord make_external_record(const options::RunOptions& options, const measure::SceneTask& task,
                                         const std::string& name, records::ExternalRecord external) {
  filters::FilterRequest request;
  request.spec.id = name;
  records::CellRecord record = measure::make_record(options, task, request);
  record.external = std::move(external);
  record.key = records::cell_key(record);
  for (const char* field : {"time_ms", "ratio_to_none", "cost", "kernel", "kernel_radius_texels", "gpu", "coverage",
                            "stability", "map_scale", "nan"})
    record.absent[field] = kAnother;
  return record;
}

void note_alignment(records::ExternalRecord& external, const CheckedImages& checked) {
  external.undefined = checked.undefined;
  external.aligned_by = checked.alignment.by;
  if (const auto& shift = checked.alignment.shift) {
    external.shift_x = shift->x;
    external.shift_y = shift->y;
  }
  external.shift_p99 = checked.alignment.p99;
}

/// What pictures show where nothing is known: the truth, unless that would be much of them.
images::Image fill_few(images::Image filled, const measure::SceneTruth& truth, std::int64_t undefined) {
  constexpr double kFew = 0.01;
  const auto receivers = static_cast<double>(std::ranges::count(truth.mask, 1));
  if (static_cast<double>(undefined) > kFew * receivers) return filled;
  for (std::size_t i = 0; i < filled.texels.size(); ++i)
    if (truth.mask[i] && !std::isfinite(filled.texels[i])) filled.texels[i] = truth.ratio.texels[i];
  return filled;
}

/// Whether two rows share a table and a grid: they differ in what drew them alone.
bool stand_together(const records::CellRecord& a, const records::CellRecord& b) {
  const auto surroundings = [](const records::CellRecord& cell) {
    nlohmann::json settings = records::cell_settings(cell);
    settings.erase("filter");
    settings.erase("params");
    return settings;
  };
  return surroundings(a) == surroundings(b);
}

void copy_shared_paths(records::ImagesRecord& to, const records::ImagesRecord& from) {
  to.depth_map = from.depth_map;
  to.texel_density = from.texel_density;
  to.truth_picture = from.truth_picture;
  to.truth_values = from.truth_values;
}

using Way = std::function<glm::vec3(const glm::vec3& position_ws)>;

glm::vec3 to_viewer(const scene::Camera& camera, const glm::vec3& position_ws) {
  return camera.orthographic_height_m > 0.0f ? -camera.forward_ws : glm::normalize(camera.position_ws - position_ws);
}

/// The triangles whose front looks that way, or else those whose back does.
truth::Occluders keep_faces(std::vector<truth::OccluderMesh> meshes, const Way& way, bool are_fronts) {
  for (truth::OccluderMesh& mesh : meshes) {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return mesh.positions[mesh.indices[i + k]]; };
      const glm::vec3 front = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      if ((glm::dot(front, way(corner(0))) > 0.0f) == are_fronts)
        kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                    mesh.indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    }
    mesh.indices = std::move(kept);
  }
  std::erase_if(meshes, [](const truth::OccluderMesh& mesh) { return mesh.indices.empty(); });
  return truth::Occluders(meshes);
}

/// Which faces cast full shadows: see OwnView.
std::vector<std::uint8_t> list_casters(const scene::Scene& scene, const measure::SceneTruth& truth) {
  std::vector<std::uint8_t> casters(truth.mask.size(), 0);
  const Way to_light = [&](const glm::vec3& position) { return scene::to_light(scene.light, position); };
  for (const bool are_fronts : {true, false}) {
    const truth::Occluders faces = keep_faces(scene::list_occluders(scene), to_light, are_fronts);
    const std::vector<float> seen =
        truth::trace_hard(faces, truth.receivers.image, scene::make_area_light(scene.light));
    for (std::size_t i = 0; i < casters.size(); ++i)
      if (truth.mask[i] && truth.area.texels[i] == 0.0f && seen[i] == 0.0f)
        casters[i] |= are_fronts ? kFrontsCast : kBacksCast;
  }
  return casters;
}

/// Which surfaces a view shows from behind: those on which lies a face whose back looks at it, and none whose front
/// does.
std::vector<std::uint8_t> list_backs(const scene::Scene& scene, const scene::Camera& camera,
                                     const measure::ViewReceivers& receivers) {
  std::vector<truth::OccluderMesh> meshes = scene::list_occluders(scene);
  std::ranges::move(scene::list_occluders(scene, false), std::back_inserter(meshes));
  const Way way = [&](const glm::vec3& position) { return to_viewer(camera, position); };
  std::vector<std::uint8_t> is_back(receivers.is_surface.size(), 0);
  for (const bool are_fronts : {false, true}) {
    const truth::Occluders faces = keep_faces(meshes, way, are_fronts);
    for (std::size_t i = 0; i < is_back.size(); ++i) {
      if (!receivers.is_surface[i] || (are_fronts && !is_back[i])) continue;
      const truth::ReceiverPoint& point = receivers.image.points[i];
      const glm::vec3 origin = faces.offset_origin(point.position_ws, point.normal_ws);
      truth::RayPacket ray;
      ray.set(0, origin, -point.normal_ws, 4.0f * glm::length(origin - point.position_ws));
      is_back[i] = std::isfinite(faces.find_nearest(ray).distances[0]) != are_fronts;
    }
  }
  return is_back;
}

/// The last line that is not empty: what a program says before it ends.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// Runs a command in its folder. Throws Error(kInput) where it does not do what it is to do.
void draw(const options::Engine& engine, const std::filesystem::path& folder, double timeout_s) {
  const std::filesystem::path picture = folder / "picture.exr";
  run::WorkerProcess process({"-c", fmt::format("cd \"$1\" && {} \"$2\" \"$3\"", engine.command), "sh",
                              std::filesystem::absolute(engine.folder.empty() ? "." : engine.folder).string(),
                              (folder / "scene.json").string(), picture.string()},
                             {.program = "/bin/sh"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  const bool ended = process.listen(std::chrono::time_point_cast<std::chrono::steady_clock::duration>(deadline));
  const run::WorkerOutcome outcome = process.end();
  const std::string said = last_line(outcome.error_text);
  const std::string end = said.empty() ? "" : fmt::format("; it said: {}", said);
  if (!ended)
    fail_input(fmt::format("the command was not done after {:g} s, and was killed (--cell-timeout){}", timeout_s, end));
  if (outcome.exit_code != 0)
    fail_input(fmt::format("the command {}{}",
                           outcome.exit_code ? fmt::format("ended with exit code {}", *outcome.exit_code)
                                             : fmt::format("was killed by signal {}", outcome.signal),
                           end));
  if (!std::filesystem::exists(picture))
    fail_input("the command ended well, and wrote no picture.exr where it was told to" + end);
}

}  // namespace

RunScorer::RunScorer(const options::RunOptions& options, options::Progress& progress)
    : options_(options),
      progress_(progress),
      results_(records::read_results(options.out / "results.json")),
      renderer_(measure::make_renderer(options.backend, options.resources)),
      cache_(options.cache, [this](const std::string& message) { progress_.note("warning: " + message); }),
      plan_(run::make_plan(options_, renderer_.context->info().renderer)) {}

void RunScorer::check_name(const std::string& name) const {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (name.empty() || name.size() > kLongestName || std::ranges::any_of(name, is_control))
    throw Error(ErrorKind::kUsage, fmt::format("--name: '{}' is no name of a row: give 1 to {} characters on one line",
                                               name, kLongestName));
  for (const records::CellRecord& cell : results_.cells)
    if (!cell.external && (cell.filter == name || cell.images.parts == name))
      throw Error(ErrorKind::kUsage,
                  fmt::format("--name: '{}' is a filter of this run: give the row a name of its own", name));
}

std::vector<analysis::Place> RunScorer::list_places() const {
  std::vector<analysis::Place> places;
  for (const run::PlannedTask& task : plan_.tasks) {
    const analysis::Place place{task.task.scene->name, task.task.camera->name};
    if (std::ranges::count(places, place) == 0) places.push_back(place);
  }
  return places;
}

const run::PlannedTask& RunScorer::find_task(const std::string& scene, const std::string& view,
                                             const options::PictureSize& size, int map_size) const {
  const std::vector<analysis::Place> places = list_places();
  std::vector<analysis::Place> chosen;
  std::vector<std::string> names;
  for (const analysis::Place& place : places) {
    names.push_back(fmt::format("{} (view {})", place.scene, place.view));
    if ((scene.empty() || place.scene == scene) && (view.empty() || place.view == view)) chosen.push_back(place);
  }
  if (chosen.size() != 1) {
    throw Error(ErrorKind::kUsage,
                fmt::format("--scene and --view: the run has {} '{}'{}; name one of {}",
                            chosen.empty() ? "no scene" : "several views of", scene,
                            view.empty() ? "" : fmt::format(" with a view '{}'", view), fmt::join(names, ", ")));
  }
  const auto is_of_place = [&](const run::PlannedTask& task) {
    return task.task.scene->name == chosen.front().scene && task.task.camera->name == chosen.front().view &&
           (map_size == 0 || task.task.map_size == map_size);
  };
  const auto is_of_size = [&](const run::PlannedTask& task) {
    const options::RunOptions& framed = plan_.scenes[task.scene].options;
    return is_of_place(task) && framed.width == size.width && framed.height == size.height;
  };
  if (const auto found = std::ranges::find_if(plan_.tasks, is_of_size); found != plan_.tasks.end()) return *found;
  if (const auto found = std::ranges::find_if(plan_.tasks, is_of_place); found != plan_.tasks.end()) return *found;
  throw Error(ErrorKind::kUsage, fmt::format("--map-size: the run has no map of {} texels a side", map_size));
}

measure::SceneAssets& RunScorer::assets_of(const run::PlannedTask& task) {
  const run::PlannedScene& planned = plan_.scenes[task.scene];
  return assets_
      .try_emplace(task.scene, renderer_, planned.options, planned.scene, cache_,
                   measure::padding_texels(planned.options))
      .first->second;
}

images::Image RunScorer::shade(const run::PlannedTask& task, const images::Image& visibility) {
  return render::shade(renderer_.shaders, assets_of(task).gbuffer(*task.task.camera), render::upload_image(visibility),
                       *task.task.scene, *task.task.camera, options_.range);
}

OwnView RunScorer::describe_own_view(const run::PlannedTask& task) {
  const scene::Camera& camera = *task.task.camera;
  const render::GBuffer& gbuffer = assets_of(task).gbuffer(camera);
  const measure::ViewSurfaces surfaces = measure::read_view_surfaces(gbuffer);
  const images::Image shading = render::read_image(gbuffer.shading_normal(), 4);
  const measure::ViewReceivers receivers = measure::make_view_receivers(surfaces, task.task.scene->light);
  const int width = receivers.image.width, height = receivers.image.height;
  OwnView own{
      receivers.mask(), receivers.is_surface, images::Image(width, height, 1), images::Image(width, height, 1), {}, {}};
  images::Image one(width, height, 1);
  const images::Image dark = shade(task, one);
  std::ranges::fill(one.texels, 1.0f);
  const images::Image lit = shade(task, one);
  if (!scene::find_beam(task.task.scene->light)) own.to_light_ws = scene::to_light(task.task.scene->light, {});
  for (std::size_t i = 0; i < own.counts.size(); ++i) {
    const glm::vec3 normal(shading.texels[4 * i], shading.texels[4 * i + 1], shading.texels[4 * i + 2]);
    own.normals_ws.push_back(normal);
    own.depth.texels[i] = surfaces.positions.texels[4 * i + 3];
    float ambient = 0.0f, direct = 0.0f;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      ambient += dark.texels[c];
      direct += lit.texels[c] - dark.texels[c];
    }
    // Under a sun without the highlights of our pictures, which others do not draw: by the colour that the ambient
    // light has.
    if (own.to_light_ws)
      direct = ambient / (render::kAmbientAtSide + (1.0f - render::kAmbientAtSide) * normal.y) *
               std::max(glm::dot(normal, *own.to_light_ws), 0.0f);
    own.direct.texels[i] = direct;
  }
  own.is_back = list_backs(*task.task.scene, camera, receivers);
  own.casters = list_casters(*task.task.scene, assets_of(task).truth(camera));
  return own;
}

std::vector<const records::CellRecord*> RunScorer::list_peers(const records::CellRecord& cell) const {
  std::vector<const records::CellRecord*> peers;
  for (const records::CellRecord& each : results_.cells)
    if (each.key != cell.key && stand_together(each, cell)) peers.push_back(&each);
  return peers;
}

images::Image RunScorer::read_visibility(const records::CellRecord& cell) const {
  if (!cell.images.exr || !cell.images.parts) return {};
  const std::string wanted = *cell.images.parts + ".visibility";
  try {
    images::ExrFile file =
        images::read_exr(options_.out / *cell.images.exr, [&](const std::string& name) { return name == wanted; });
    return file.parts.empty() ? images::Image() : std::move(file.parts.front().image);
  } catch (const Error&) {
    return {};  // the row says less
  }
}

/// The scene, the settings or the program may have changed since the run.
void RunScorer::require_same_truth(const run::PlannedTask& task, const images::Image& area) const {
  const std::filesystem::path file = options_.out / run::exr_name(plan_.scenes[task.scene].options, task.task);
  if (!std::filesystem::exists(file)) return;  // a run without grids does not keep it
  const images::ExrFile kept = images::read_exr(file, [](const std::string& name) { return name == run::kTruthPart; });
  if (kept.parts.empty()) return;
  const images::Image& was = kept.parts.front().image;
  const std::vector<std::uint8_t> all(area.texels.size(), 1);
  constexpr double kRounding = 1e-4;  // another OpenGL's rounding moves a few receivers
  if (was.texels.size() == area.texels.size() &&
      metrics::measure_error(was.texels, area.texels, all).value_or(metrics::ErrorStats()).rmse < kRounding)
    return;
  fail_input(
      "the truth of this scene is no longer the report's: the scene, the settings or the program have changed "
      "since the run; run it again",
      file.string());
}

void RunScorer::compare_with_peers(records::CellRecord& cell, const images::Image& visibility,
                                   const std::vector<std::uint8_t>& counts, const images::Image& truth) const {
  records::ExternalRecord& external = *cell.external;
  for (const records::CellRecord* peer : list_peers(cell)) {
    const images::Image own = read_visibility(*peer);
    if (own.texels.size() != visibility.texels.size() || peer->external) continue;
    const auto apart = metrics::measure_error(visibility.texels, own.texels, counts);
    const auto error = metrics::measure_error(own.texels, truth.texels, counts);
    if (error) external.peers[*peer->images.parts] = error->rmse;
    if (!apart || (external.nearest_rmse && *external.nearest_rmse <= apart->rmse)) continue;
    external.nearest = *peer->images.parts;
    external.nearest_rmse = apart->rmse;
  }
}

/// The error as the sum of what its filter does beside one lookup, what its map does, and what a light without size
/// does.
void RunScorer::attribute(measure::MeasuredCell& cell, const images::Image& map, const Meta& meta,
                          const run::PlannedTask& task, const measure::SceneTruth& truth) const {
  if (!meta.map_from_world)
    fail_input(
        "--shadow-map needs to be known where it lies: give 'map_from_world' in the meta.json, 16 numbers, columns "
        "first, that lead from the world to u, v and depth in the map");
  std::vector<glm::vec3> to_light;
  for (const truth::ReceiverPoint& receiver : truth.receivers.image.points)
    to_light.push_back(scene::to_light(task.task.scene->light, receiver.position_ws));
  const std::vector<double> looked_up = look_up({map, *meta.map_from_world}, truth.receivers.image, to_light);
  measure::note_attribution(cell, metrics::attribute_error({.image = cell.visibility.texels,
                                                            .model = {},
                                                            .closer = looked_up,
                                                            .kernel = truth.rays.hard,
                                                            .area = truth.area.texels,
                                                            .mask = truth.mask}));
  cell.record.absent.erase("attribution");
  cell.record.absent["attribution.numeric"] = kAnother;
}

std::pair<records::CellRecord, std::vector<Finding>> RunScorer::score(const ScoreRequest& request) {
  check_name(request.name);
  const ExternalImages drawn = read_external_images(request.files);
  const images::Image& any = drawn.visibility ? *drawn.visibility : *drawn.lit;
  const run::PlannedTask& task = find_task(request.scene, request.view, {any.width, any.height}, request.map_size);
  const run::PlannedScene& planned = plan_.scenes[task.scene];
  const Meta meta = request.meta ? read_meta(*request.meta) : Meta();
  const std::string view_name = run::name_view(planned, *task.task.camera);
  if (!meta.truth.empty() && meta.truth != view_name) {
    fail_input(fmt::format("its 'truth' is not that of {}, view {}: it was drawn from the scene.json of another scene, "
                           "size or light; export this run's scene again",
                           task.task.scene->name, task.task.camera->name),
               request.meta->string());
  }
  const measure::SceneTruth& truth = assets_of(task).truth(*task.task.camera);
  if (!truth.absent.empty()) fail_input("there is nothing to score against: " + truth.absent, options_.out.string());
  require_same_truth(task, truth.area);
  const OwnView own = describe_own_view(task);
  const CheckedImages checked = check_images(drawn, own);
  const auto refusal = std::ranges::find_if(checked.findings, &Finding::refuses);
  if (refusal != checked.findings.end() && !request.unaligned)
    fail_input(refusal->text + ". --unaligned scores it all the same, and marks the row", drawn.names);

  measure::MeasuredCell cell;
  cell.label = request.name;
  cell.record = make_external_record(planned.options, task.task, request.name, meta.external);
  note_alignment(*cell.record.external, checked);
  cell.record.external->truth = view_name;
  cell.record.external->unaligned = refusal != checked.findings.end();
  for (const Finding& each : checked.findings)
    cell.record.warnings.push_back(fmt::format("{}, {}: {}", request.name, task.task.scene->name, each.text));
  cell.record.receivers = std::ranges::count(truth.mask, 1);
  cell.visibility = truth.receivers.to_image(checked.visibility.texels);
  cell.picture = shade(task, fill_few(cell.visibility, truth, checked.undefined));
  measure::score(cell, truth);
  if (drawn.unbiased) cell.unbiased = truth.receivers.to_image(drawn.unbiased->texels);
  options::RunOptions traced = planned.options;
  traced.attribution = false;
  measure::CellAnalyser({renderer_, traced, task.task, assets_of(task)}, truth).analyse(cell);
  for (const char* field : {"attribution", "artefact.noise", "error.kernel_rmse", "excused"})
    cell.record.absent[field] = kAnother;
  if (!drawn.unbiased)
    cell.record.absent["artefact.contact_gap"] = "its picture without bias is not known: give --unbiased";
  if (drawn.shadow_map) attribute(cell, *drawn.shadow_map, meta, task, truth);
  const auto inside = metrics::measure_error(cell.visibility.texels, truth.area.texels, find_inside(own, own.counts));
  if (inside) cell.record.external->inside_rmse = inside->rmse;
  std::vector<std::uint8_t> counts = truth.mask;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (!std::isfinite(cell.visibility.texels[i])) counts[i] = 0;
  compare_with_peers(cell.record, cell.visibility, counts, truth.area);

  ContentHash content;
  content.add_values(std::span<const float>(cell.visibility.texels));
  cell.record.content = content.name();
  const FolderLock lock(options_.out);
  run::write_cell_pictures(planned.options, task.task, cell, truth.mask);
  cell.record.images.exr =
      fmt::format("{}.{}.exr", run::task_stem(planned.options, task.task), make_file_stem(request.name));
  cell.record.images.parts = cell.label;
  images::write_exr(options_.out / *cell.record.images.exr,
                    {{cell.label + ".visibility", {"Y"}, cell.visibility, false}},
                    {{"shadowbench:scene", task.task.scene->name}, {"shadowbench:view", task.task.camera->name}});
  if (const auto peers = list_peers(cell.record); !peers.empty()) {
    copy_shared_paths(cell.record.images, peers.front()->images);
    cell.record.machine = peers.front()->machine;  // nothing of the row was timed: it is of no kind of its own
  }
  if (options_.grids && options_.pictures) cell.record.images.grid = run::name_grid(planned.options, task.task);
  keep(cell.record);
  return {cell.record, checked.findings};
}

/// Puts a row behind the others of its place, or in the place of the one of its name.
void RunScorer::keep(const records::CellRecord& cell) {
  records::write_cell(options_.out, cell);
  std::erase_if(rows_, [&](const records::CellRecord& row) { return row.key == cell.key; });
  rows_.push_back(cell);
  insert(cell);
}

void RunScorer::insert(const records::CellRecord& cell) {
  std::vector<records::CellRecord>& cells = results_.cells;
  if (const auto known = std::ranges::find(cells, cell.key, &records::CellRecord::key); known != cells.end()) {
    *known = cell;
    return;
  }
  const auto last = std::find_if(cells.rbegin(), cells.rend(),
                                 [&](const records::CellRecord& each) { return stand_together(each, cell); });
  cells.insert(last.base(), cell);
}

void RunScorer::export_place(const analysis::Place& place, const std::filesystem::path& folder) {
  const run::PlannedTask& task = find_task(place.scene, place.view, {}, 0);
  const run::PlannedScene& planned = plan_.scenes[task.scene];
  nlohmann::ordered_json description = describe_view(planned, *task.task.camera);
  description["maps"].push_back(describe_map(planned, task.task.map_size,
                                             assets_of(task).light_map(*task.task.camera, task.task.map_size).layers));
  write_exported_scene(folder, planned, *task.task.camera, description);
}

void RunScorer::finish() {
  const FolderLock lock(options_.out);
  results_ = records::read_results(options_.out / "results.json");  // others may have scored meanwhile
  for (const records::CellRecord& row : rows_) insert(row);
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : results_.cells) keys.push_back(cell.key);
  pages::write_report(options_.out, results_.run, keys);
}

std::vector<std::pair<records::CellRecord, std::vector<Finding>>> run_engines(
    RunScorer& scorer, const std::vector<options::Engine>& engines, const ScoreRequest& request, double timeout_s,
    options::Progress& progress) {
  std::vector<std::pair<records::CellRecord, std::vector<Finding>>> rows;
  std::vector<std::string> failures;
  for (const options::Engine& engine : engines) scorer.check_name(engine.name);
  for (const analysis::Place& place : scorer.list_places()) {
    if ((!request.scene.empty() && place.scene != request.scene) ||
        (!request.view.empty() && place.view != request.view))
      continue;
    const ScratchFolder folder(std::filesystem::absolute(make_temporary_folder_path(scorer.folder(), "engine")));
    scorer.export_place(place, folder.path());
    for (const options::Engine& engine : engines) {
      progress.note(fmt::format("{}: {}", place.scene, engine.name));
      try {
        for (const char* old : {"picture.exr", "meta.json", "shadow_map.exr"})
          std::filesystem::remove(folder.path() / old);
        draw(engine, folder.path(), timeout_s);
        ScoreRequest own = request;
        own.name = engine.name;
        own.scene = place.scene;
        own.view = place.view;
        own.files = {.layers = (folder.path() / "picture.exr").string()};
        if (std::filesystem::exists(folder.path() / "meta.json")) own.meta = folder.path() / "meta.json";
        if (const auto map = folder.path() / "shadow_map.exr"; std::filesystem::exists(map))
          own.files.shadow_map = map.string();
        rows.push_back(scorer.score(own));
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::kInput) {
          if (!rows.empty()) scorer.finish();
          throw;
        }
        failures.push_back(fmt::format("{}, {}: {}", engine.name, place.scene, error.what()));
        progress.note("failed: " + failures.back());
      }
    }
  }
  if (!rows.empty()) scorer.finish();
  if (failures.empty() && rows.empty())
    throw Error(ErrorKind::kUsage, fmt::format("--scene: the run has no scene '{}' with such a view", request.scene));
  if (failures.empty()) return rows;
  fail_input(fmt::format("{} of {} pictures could not be scored; the first: {}", failures.size(),
                         failures.size() + rows.size(), failures.front()));
}

}  // namespace shadowbench::engines
