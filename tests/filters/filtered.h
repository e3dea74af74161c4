#pragma once

#include <memory>
#include <random>
#include <string>
#include <utility>

#include "filters/catalogue.h"
#include "filters/front_matter.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// A map whose texels left of `edge` hold `near`, the others `far`.
inline DepthMap make_edge(int size, int edge, float near, float far) {
  DepthMap map{size, {}};
  for (int i = 0; i < size * size; ++i) map.stored.push_back(i % size < edge ? near : far);
  return map;
}

/// A map of depths that are spread evenly over 0 .. 1.
inline DepthMap make_random_map(int size, unsigned seed) {
  std::mt19937 random(seed);
  DepthMap map{size, {}};
  for (int i = 0; i < size * size; ++i) map.stored.push_back(static_cast<float>(random()) * 0x1p-32f);
  return map;
}

inline const Catalogue& built_in() {
  static const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return catalogue;
}

inline FilterRequest request_of(const std::string& text) { return built_in().parse_requests(text).front(); }

/// A filter's file that is right: these lines of its front matter begin at line 5.
inline std::string write_filter(const std::string& lines, const std::string& glsl, const char* kind = "other") {
  return std::string("/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"") + kind + "\"\n" + lines + "+++*/\n" + glsl;
}

/// What such a file asks for by its defaults.
inline FilterRequest request_of_file(const std::string& text, const std::string& name = "test.glsl") {
  FilterRequest request;
  request.spec = parse_filter(text, name);
  request.values = default_values(request.spec);
  return request;
}

/// Looks receivers up by a filter.
class Filtered {
 public:
  Filtered(FilterRequest request, const DepthMap& map, Precision precision = Precision::kDouble)
      : request_(std::move(request)),
        lookup_(find_model(request_.spec)->prepare({request_.spec, request_.values, map, {}, 0}, precision)) {}
  Filtered(const std::string& text, const DepthMap& map, Precision precision = Precision::kDouble)
      : Filtered(request_of(text), map, precision) {}

  ModelResult find(const Receiver& r) const { return lookup_->at(r); }
  double at(const Receiver& r) const { return find(r).visibility; }
  double radius_at(const Receiver& r) const { return find(r).disk_radius_texels; }

 private:
  FilterRequest request_;
  std::unique_ptr<Lookup> lookup_;
};

/// A receiver at a position in texels.
inline Receiver make_receiver_at(const DepthMap& map, double x, double y, float depth) {
  Receiver r;
  r.uv = {static_cast<float>(x / map.size), static_cast<float>(y / map.size)};
  r.depth = depth;
  return r;
}

}  // namespace shadowbench::filters
