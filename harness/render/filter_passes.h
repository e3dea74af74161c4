#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "harness/render/gbuffer.h"
#include "harness/render/prefilter.h"
#include "harness/render/screen_passes.h"

namespace shadowbench::render {

/// What a filter costs, and how far it reads, on any machine.
struct FilterCost {
  std::optional<double> fetches;  ///< mean texture fetches per receiver; empty: the filter reads samplers itself
  double fetches_64 = 0.0;        ///< of them those of texels of 64 bits
  double fetches_128 = 0.0;       ///< and of 128
  /// From a receiver to the centre of the farthest texel that counts, on either axis, the prefilter included; empty:
  /// the filter reads samplers itself, or the map reaches no receiver.
  std::optional<double> reach_texels;
  int most_turns = 0;                 ///< of one of the lookup's loops, at any receiver
  std::int64_t bytes_per_texel = 0;   ///< of the maps that the lookup reads
  std::int64_t passes = 0;            ///< depth map, encode, blur, the filter's own, lookup
  std::int64_t map_bytes = 0;         ///< of the maps that the lookup reads
  ScreenReads screen;                 ///< of screen passes
  std::int64_t prefilter_texels = 0;  ///< texels that encode, blur and the filter's own passes write
};

/// What the lookups of a layer read, pixel by pixel, the lower row first.
struct CountedReads {
  std::vector<float> reads;  ///< four a pixel: fetches, or -1 without a lookup; their reach, texels; turns of a loop
  std::vector<float> wide;   ///< two a pixel: of the fetches those of texels of 64, and of 128 bits
};

/// What a lookup reads of its receivers; the compiler drops what no filter uses.
struct ReceiverReads {
  bool place = false;     ///< its place in the map, and its depth
  bool plane = false;     ///< its plane, n.l and view depth
  bool position = false;  ///< its place in the world
  bool normal = false;

  auto operator<=>(const ReceiverReads&) const = default;
};

/// One filter, with its parameters, over one G-buffer and one shadow map. The library of shaders must outlive it.
class FilterPasses {
 public:
  /// Compiles what this filter needs, and nothing else.
  /// `map`, which has been drawn, says how large the maps are that it will read, and whether they store depth linearly
  /// or reversed; those maps tell a perspective's ratio themselves. It need not outlive this object.
  /// Throws Error(kFilter) with the line of the filter's file, Error(kUsage) where it reads the samplers itself
  /// and would take what the map's curve makes of depth for depth.
  FilterPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
               const LightLayers& light);

  /// Changes the light and parameter values without compiling anything; the result equals that of new passes. Requires
  /// that only values change that are neither `const` nor texts, and a light with the same range rule, map size and
  /// number of layers, with a bias by slope only if the one before had it, and with a map that curves depth only if the
  /// one before did.
  void retune(const filters::ParamValues& values, const LightLayers& light);

  /// The same; parameters stay.
  void retune(const LightLayers& light);

  /// The format of the encoded map; nothing for filters that read depth.
  std::optional<GLenum> encoded_format() const {
    return prefilter_ ? std::optional(prefilter_->format()) : std::nullopt;
  }

  bool has_prefilter() const { return prefilter_ || own_; }

  /// Encode, blur, and the steps of the filter's own passes; in all layers of the map.
  int prefilter_passes() const {
    return layers() * ((prefilter_ ? prefilter_->passes() : 0) + (own_ ? own_->passes() : 0));
  }

  /// Encodes and blurs the map, and runs the filter's own passes; does nothing for filters that read depth.
  void prefilter(const ShadowMap& map);

  /// What encodes and blurs, turned to a layer of the map; null for filters that read depth.
  Prefilter* encoded_map(int layer = 0);

  /// The lookup, then what makes the maps that it reads, in all layers of the light's map; `depth_bytes` are those of a
  /// texel of the depth map.
  std::vector<DrawnPass> list_passes(int depth_bytes) const;

  /// Looks every receiver up; `target` is R32F, of the G-buffer's size. Background is 1. Of a map with layers each is
  /// looked up in a pass of its own, for the receivers that it serves, and what they make of their shares is added.
  /// The filter's screen passes follow.
  /// Only in `columns`, from the first up to the second, where they are given.
  void lookup(const GBuffer& gbuffer, const ShadowMap& map, ImageTarget& target,
              const std::optional<glm::ivec2>& columns = std::nullopt);

  bool has_screen() const { return screen_.has_value(); }

  /// The two parts of lookup(), one after the other: the second is nothing without screen passes.
  void look_up(const GBuffer& gbuffer, const ShadowMap& map, ImageTarget& target,
               const std::optional<glm::ivec2>& columns = std::nullopt);
  void filter_screen(const GBuffer& gbuffer, ImageTarget& target,
                     const std::optional<glm::ivec2>& columns = std::nullopt);

  /// Compiles and runs the counting variant of the lookup. Call after prefilter().
  FilterCost measure_cost(const GBuffer& gbuffer, const ShadowMap& map);

  /// The same, layer by layer. Requires a filter that does not read the samplers itself.
  std::vector<CountedReads> count_reads(const GBuffer& gbuffer, const ShadowMap& map);

  /// How far from where they are, in texels, the lookup's fetches reach by what a blur before it has brought there.
  double blurred_reach() const;

  /// What the lookup reads of its receivers: a pass that reads as much, and nothing of the map, costs what is not the
  /// filter's own.
  ReceiverReads receiver_reads() const;

  const filters::FilterRequest& request() const { return request_; }
  LightLayers light() const;
  int layers() const { return static_cast<int>(layers_.size()); }

 private:
  /// A layer of the light's map. Of several each has maps of its own.
  struct Layer {
    LightSetup light;
    std::shared_ptr<ImageTarget> encoded = nullptr;
    std::shared_ptr<PassMaps> maps = nullptr;  ///< of the filter's own passes
  };

  ShaderLibrary* shaders_;
  filters::FilterRequest request_;
  std::vector<Layer> layers_;
  int map_size_;
  Defines map_defines_;
  std::optional<Prefilter> prefilter_;
  std::optional<OwnPasses> own_;
  std::optional<ScreenPasses> screen_;
  gl::Program lookup_;
  std::optional<gl::Texture> blue_noise_;  ///< for filters that read it
  gl::FullscreenTriangle triangle_;

  void select(int layer);
  std::int64_t count_map_bytes(const ShadowMap& map) const;
  void set_uniforms(gl::Program& lookup, const LightSetup& light) const;
  /// `body` takes the place of the filter's own.
  gl::Program compile_lookup(Defines defines, const std::optional<std::string>& body = std::nullopt) const;
  const ReceiverBuffer& bind_lookup(gl::Program& program, const GBuffer& gbuffer, int layer, const ShadowMap& map);
  CountingSource make_counting_source() const;
  void count_fetches(FilterCost& cost, const GBuffer& gbuffer, const ShadowMap& map);
};

}  // namespace shadowbench::render
