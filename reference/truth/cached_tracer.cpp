#include "reference/truth/cached_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "reference/truth/embree.h"

namespace shadowbench::truth {
namespace {

constexpr std::uintmax_t kMostHeaderBytes = 65536;
constexpr int kCompression = 4;  // smaller than 1, and no slower

constexpr std::string_view kMark = "shadowbench truth ";
constexpr const char* kTag = "CACHEDIR.TAG";
/// Source: Cache Directory Tagging Specification 0.6; backups leave out a folder that has it.
constexpr std::string_view kTagText = "Signature: 8a477f597d28d172789f06886806bc55\n# Made by shadowbench\n";

/// Whether it is a file, and no link to one, that begins so.
bool begins_with(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  if (std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::regular) return false;
  std::string head(text.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == text;
}

bool is_truth(const std::filesystem::path& path) { return path.extension() == ".truth" && begins_with(path, kMark); }

/// Whether this program made the folder: it has our tag, or nothing but what is ours, as versions of before left it.
bool is_ours(const std::filesystem::path& folder) {
  if (begins_with(folder / kTag, kTagText)) return true;
  std::error_code error;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end; file.increment(error))
    if (!is_truth(*file) && !is_temporary(*file) && file->path().filename() != "gpu") return false;
  return true;
}

/// A file is this line, then all layers as floats, compressed with zlib.
std::string make_header(const std::string& name, const std::vector<float>& values, std::size_t layers) {
  ContentHash checksum;
  checksum.add_values(std::span<const float>(values));
  return fmt::format("{}1 {} {}x{} {}\n", kMark, name, layers, values.size(), checksum.name());
}

/// Returns all layers one after the other; nothing if the file is damaged or holds something else.
std::optional<std::vector<float>> read_values(const std::filesystem::path& path, const std::string& name,
                                              std::size_t layers, std::size_t values) {
  const std::uintmax_t packed_bytes = bound_compressed(layers * values * sizeof(float));
  try {
    const std::vector<unsigned char> bytes = read_file_bytes(path, packed_bytes + kMostHeaderBytes);
    const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<float> all(layers * values);
    const auto packed = std::as_bytes(std::span(file.substr(std::min(file.find('\n'), file.size() - 1) + 1)));
    const bool is_whole = decompress_bytes(packed, std::as_writable_bytes(std::span(all))) &&
                          file.starts_with(make_header(name, all, layers));
    return is_whole ? std::optional(std::move(all)) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void write_layers(const std::filesystem::path& path, const std::string& name, const Layers& layers) {
  std::vector<float> all;
  for (const std::vector<float>& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
  AtomicFile file(path);
  file.write(make_header(name, all, layers.size()));
  file.write(compress_bytes(std::as_bytes(std::span(all)), kCompression));
  file.commit();
}

/// Names the code that traces: it changes with the sources of this folder and of the kernels, and with Embree's
/// version.
constexpr const char* kVersion = SHADOWBENCH_TRUTH_SOURCES " Embree " RTC_VERSION_STRING;
constexpr std::size_t kTracedLayers = 5;
constexpr std::size_t kViewLayers = kTracedLayers + 4;

std::string name_geometry(const std::vector<OccluderMesh>& meshes) {
  ContentHash hash;
  hash.add(kVersion);
  for (const OccluderMesh& mesh : meshes) {
    hash.add_values(std::span<const glm::vec3>(mesh.positions));
    hash.add_values(std::span<const std::uint32_t>(mesh.indices));
    if (!mesh.cut_out) continue;
    const CutOut& holes = *mesh.cut_out;
    hash.add_values(std::span<const glm::vec2>(holes.uvs));
    hash.add(fmt::format("{} {} {} {} {}", holes.width, holes.height, holes.base_alpha, holes.cutoff, holes.dims));
    hash.add_values(std::span<const std::uint8_t>(holes.alpha));
  }
  return hash.name();
}

std::string name_vector(const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string name_grid(const MapGrid& grid) {
  std::string name = fmt::format("texel {} light {} right {} up {}", grid.texel_size_ws, name_vector(grid.to_light),
                                 name_vector(grid.right), name_vector(grid.up));
  if (grid.lamp) name += fmt::format(" lamp {} {}", name_vector(grid.lamp->position_ws), grid.lamp->reference_m);
  if (grid.curved) name += " " + grid.curved->name;
  return name;
}

std::string name_light(const AreaLight& light) {
  return fmt::format("light {} at {} u {} v {}", static_cast<int>(light.shape()),
                     name_vector(light.centre_direction(glm::dvec3(0.0))), name_vector(light.half_u()),
                     name_vector(light.half_v()));
}

Layers to_layers(const TracedVisibility& traced) {
  return {traced.visibility,
          traced.standard_error,
          {traced.unanimous.begin(), traced.unanimous.end()},
          {traced.rays.begin(), traced.rays.end()},
          traced.variance};
}

TracedVisibility from_layers(Layers layers) {
  return {.visibility = std::move(layers[0]),
          .standard_error = std::move(layers[1]),
          .unanimous = {layers[2].begin(), layers[2].end()},
          .rays = {layers[3].begin(), layers[3].end()},
          .variance = std::move(layers[4])};
}

}  // namespace

TruthCache::TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note)
    : folder_(std::move(folder)), is_ours_(!folder_.empty() && truth::is_ours(folder_)), note_(std::move(note)) {
  if (is_ours_) remove_temporary_files(folder_, is_gone);
}

std::optional<Layers> TruthCache::load(const std::string& name, std::size_t layers, std::size_t values) {
  std::error_code error;
  std::optional<std::vector<float>> all;
  if (!folder_.empty()) all = read_values(path_of(name), name, layers, values);
  if (!all) {
    ++traced_;
    return std::nullopt;
  }
  std::filesystem::last_write_time(path_of(name), std::filesystem::file_time_type::clock::now(), error);
  ++loaded_;
  Layers found;
  for (std::size_t i = 0; i < layers; ++i) {
    const auto begin = all->begin() + static_cast<std::ptrdiff_t>(i * values);
    found.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(values));
  }
  return found;
}

void TruthCache::store(const std::string& name, const Layers& layers) {
  if (folder_.empty() || !note_) return;
  try {
    if (is_ours_ && !std::filesystem::exists(folder_ / kTag)) write_text_file(folder_ / kTag, kTagText);
    write_layers(path_of(name), name, layers);
  } catch (const Error& error) {
    note_(fmt::format("traced images are not kept for the next run: {}; choose another folder with --cache",
                      error.what()));
    note_ = nullptr;  // nothing more is written, but what the folder holds is still read
  }
}

void TruthCache::prune(std::uintmax_t max_bytes) const {
  if (!is_ours_) return;
  struct Entry {
    std::filesystem::path path;
    std::filesystem::file_time_type used;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  std::filesystem::directory_iterator file(folder_, error);
  for (; !error && file != std::filesystem::directory_iterator(); file.increment(error)) {
    if (!is_truth(*file)) continue;
    std::error_code gone;
    const Entry entry{file->path(), file->last_write_time(gone), file->file_size(gone)};
    if (gone) continue;
    total += entry.bytes;
    entries.push_back(entry);
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= max_bytes) return;
    if (std::filesystem::remove(entry.path, error)) total -= entry.bytes;
  }
}

CachedTracer::CachedTracer(MeshList list_meshes, TruthCache& cache, std::uint32_t seed)
    : list_meshes_(std::move(list_meshes)), cache_(cache) {
  settings_.seed = seed;
}

const std::string& CachedTracer::geometry() {
  if (geometry_.empty()) geometry_ = name_geometry(list_meshes_());
  return geometry_;
}

const Occluders& CachedTracer::occluders() {
  if (!occluders_) occluders_.emplace(list_meshes_());
  return *occluders_;
}

const SampleSets& CachedTracer::samples(const AreaLight& light) {
  const auto found = samples_.find(light.shape());
  if (found != samples_.end()) return found->second;
  return samples_.emplace(light.shape(), make_light_samples(light, settings_)).first->second;
}

TraceSettings CachedTracer::within(double standard_error) const {
  TraceSettings settings = settings_;
  settings.standard_error = standard_error;
  return settings;
}

Layers CachedTracer::find_or_trace(const ReceiverImage& receivers, const std::string& what, std::size_t count,
                                   const std::function<Layers()>& trace) {
  if (receivers.content.empty()) return trace();
  ContentHash hash;
  for (const std::string& part :
       {geometry(), receivers.content, what,
        fmt::format("{} {} {}", settings_.standard_error, settings_.max_points, settings_.seed)})
    hash.add(part);
  const std::string name = hash.name();
  if (auto kept = cache_.load(name, count, receivers.points.size())) return std::move(*kept);
  Layers layers = trace();
  cache_.store(name, layers);
  return layers;
}

ViewRays CachedTracer::trace_view(const ReceiverImage& receivers, const AreaLight& light) {
  Layers layers = find_or_trace(receivers, name_light(light), kViewLayers, [&] {
    const TracedVisibility area = trace_area(occluders(), receivers, light, settings_, samples(light));
    Layers traced = to_layers(area);
    traced.push_back(area.ratio);
    traced.push_back(area.ratio_error);
    traced.push_back(trace_hard(occluders(), receivers, light));
    traced.push_back(trace_first_blockers(occluders(), receivers, light));
    return traced;
  });
  std::vector<float> hard = std::move(layers[kViewLayers - 2]), blockers = std::move(layers[kViewLayers - 1]);
  TracedVisibility area = from_layers(layers);
  area.ratio = std::move(layers[kTracedLayers]);
  area.ratio_error = std::move(layers[kTracedLayers + 1]);
  return {std::move(area), std::move(hard), std::move(blockers)};
}

std::vector<float> CachedTracer::trace_light(const ReceiverImage& receivers, const AreaLight& light) {
  TraceSettings few = settings_;
  few.max_points = kFirstPoints;
  const auto trace = [&] { return Layers{trace_area(occluders(), receivers, light, few).ratio}; };
  return find_or_trace(receivers, name_light(light) + " by few rays", 1, trace).front();
}

TracedVisibility CachedTracer::find_or_trace(const ReceiverImage& receivers, const std::string& what,
                                             const std::function<TracedVisibility()>& trace) {
  return from_layers(find_or_trace(
      receivers, what, kTracedLayers, [&] { return to_layers(trace()); }));
}

TracedVisibility CachedTracer::trace_kernel(const ReceiverImage& receivers, const filters::Kernel& kernel,
                                            const MapGrid& grid) {
  return find_or_trace(
      receivers, fmt::format("kernel {} {} within {}", kernel.name(), name_grid(grid), kKernelStandardError),
      [&] { return truth::trace_kernel(occluders(), receivers, kernel, grid, within(kKernelStandardError)); });
}

TracedVisibility CachedTracer::trace_disks(const ReceiverImage& receivers, std::span<const float> radii_texels,
                                           const MapGrid& grid) {
  ContentHash radii;
  radii.add_values(radii_texels);
  return find_or_trace(
      receivers, fmt::format("disks {} {} within {}", radii.name(), name_grid(grid), kKernelStandardError),
      [&] { return truth::trace_disks(occluders(), receivers, radii_texels, grid, within(kKernelStandardError)); });
}

TracedVisibility CachedTracer::trace_surroundings(const ReceiverImage& receivers, double half_width_texels,
                                                  const MapGrid& grid) {
  return find_or_trace(
      receivers, fmt::format("square {} {}", half_width_texels, name_grid(grid)),
      [&] {
        TraceSettings rough = within(1.0);
        rough.max_points = kFirstPoints;
        return trace_square(occluders(), receivers, half_width_texels, grid, rough);
      });
}

}  // namespace shadowbench::truth
