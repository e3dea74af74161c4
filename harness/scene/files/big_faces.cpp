#include "harness/scene/files/big_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <sstream>
#include <utility>

#include "filters/base/error.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t kManyCorners = 257;

/// Newell's normal: twice the area of the polygon, seen along each axis.
glm::dvec3 newell_normal(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return normal;
}

/// The polygon along the axis in which it is largest, counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::dvec3>& corners) {
  const glm::dvec3 normal = newell_normal(corners), size = glm::abs(normal);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double side = normal[z] < 0.0 ? -1.0 : 1.0;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& corner : corners) flat.emplace_back(side * corner[x], corner[y]);
  return flat;
}

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

using Triangle = std::array<glm::dvec2, 3>;  // counter-clockwise

bool holds(const Triangle& t, const glm::dvec2& p) {
  return cross(t[0], t[1], p) >= 0.0 && cross(t[1], t[2], p) >= 0.0 && cross(t[2], t[0], p) >= 0.0;
}

/// Points that may lie in a triangle, in a k-d tree.
class PointTree {
 public:
  PointTree(const std::vector<glm::dvec2>& places, std::vector<std::uint32_t> points)
      : places_(places), points_(std::move(points)) {
    if (!points_.empty()) build(0, points_.size());
  }

  /// Whether one of the points lies in the triangle, and at none of its corners. Points for which `is_over` holds are
  /// left out from now on.
  template <class IsOver>
  bool any_in(const Triangle& t, const IsOver& is_over) {
    std::vector<std::size_t> open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      Node& node = nodes_[at];
      if (misses(t, node)) continue;
      if (node.second > 0) {
        open.insert(open.end(), {node.second, at + 1});
        continue;
      }
      while (node.begin < node.end && is_over(points_[node.end - 1])) --node.end;
      for (std::size_t i = node.begin; i < node.end; ++i) {
        const glm::dvec2& p = places_[points_[i]];
        if (p != t[0] && p != t[1] && p != t[2] && holds(t, p) && !is_over(points_[i])) return true;
      }
    }
    return false;
  }

 private:
  struct Node {
    std::size_t begin = 0, end = 0;
    glm::dvec2 low{0.0}, high{0.0};
    std::size_t second = 0;  ///< the second child, the first one follows its parent; 0: a leaf
  };

  const std::vector<glm::dvec2>& places_;
  std::vector<std::uint32_t> points_;
  std::vector<Node> nodes_;

  void build(std::size_t begin, std::size_t end) {
    constexpr std::size_t kLeafPoints = 8;
    const std::size_t at = nodes_.size();
    nodes_.push_back({begin, end, places_[points_[begin]], places_[points_[begin]]});
    for (std::size_t i = begin; i < end; ++i) {
      nodes_[at].low = glm::min(nodes_[at].low, places_[points_[i]]);
      nodes_[at].high = glm::max(nodes_[at].high, places_[points_[i]]);
    }
    if (end - begin <= kLeafPoints) return;
    const glm::dvec2 size = nodes_[at].high - nodes_[at].low;
    const int axis = size.x >= size.y ? 0 : 1;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto place = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(place(begin), place(middle), place(end),
                     [&](std::uint32_t a, std::uint32_t b) { return places_[a][axis] < places_[b][axis]; });
    build(begin, middle);
    nodes_[at].second = nodes_.size();
    build(middle, end);
  }

  /// Whether a box lies wholly outside one side of the triangle, or of the box around it.
  static bool misses(const Triangle& t, const Node& box) {
    const glm::dvec2 low = glm::min(glm::min(t[0], t[1]), t[2]), high = glm::max(glm::max(t[0], t[1]), t[2]);
    if (box.low.x > high.x || box.low.y > high.y || box.high.x < low.x || box.high.y < low.y) return true;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 &a = t[i], &b = t[(i + 1) % 3];
      const glm::dvec2 innermost{b.y > a.y ? box.low.x : box.high.x, b.x > a.x ? box.high.y : box.low.y};
      if (cross(a, b, innermost) < 0.0) return true;
    }
    return false;
  }
};

/// Cuts ears off a polygon. In each round no two of them are neighbours, so that a convex polygon is halved by each.
class EarClipper {
 public:
  explicit EarClipper(std::vector<glm::dvec2> corners) : corners_(std::move(corners)) {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      before_.push_back((i + n - 1) % n);
      after_.push_back((i + 1) % n);
    }
    last_round_.resize(n, 0);
    gone_.resize(n, false);
  }

  std::vector<std::uint32_t> clip() {
    std::vector<std::uint32_t> open(corners_.size()), blunt;
    std::iota(open.begin(), open.end(), 0U);
    std::ranges::copy_if(open, std::back_inserter(blunt), [&](std::uint32_t i) { return !is_convex(i); });
    PointTree blocking(corners_, std::move(blunt));  // no other corner becomes reflex
    std::size_t left = corners_.size();
    for (int round = 1; left > 3 && !open.empty(); ++round) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t i : open) {
        if (gone_[i] || left == 3) continue;
        if (last_round_[i] == round) {
          next.push_back(i);
        } else if (is_ear(i, blocking)) {
          cut(i, round, next);
          --left;
        }
      }
      open = std::move(next);
    }
    add_fan(left);
    return std::move(triangles_);
  }

 private:
  std::vector<glm::dvec2> corners_;
  std::vector<std::uint32_t> before_, after_, triangles_;
  std::vector<int> last_round_;  ///< in which a neighbour was cut off
  std::vector<bool> gone_;

  bool is_convex(std::uint32_t i) const { return cross(corners_[before_[i]], corners_[i], corners_[after_[i]]) > 0.0; }

  bool is_ear(std::uint32_t i, PointTree& blocking) const {
    return is_convex(i) && !blocking.any_in(
                               {corners_[before_[i]], corners_[i], corners_[after_[i]]},
                               [&](std::uint32_t p) { return gone_[p] || is_convex(p); });
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.insert(triangles_.end(), {a, b, c}); }

  void cut(std::uint32_t i, int round, std::vector<std::uint32_t>& next) {
    add(before_[i], i, after_[i]);
    gone_[i] = true;
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
    for (const std::uint32_t neighbour : {before_[i], after_[i]}) {
      last_round_[neighbour] = round;
      next.push_back(neighbour);
    }
  }

  /// Adds what is left: one triangle, or more where the polygon touches or crosses itself.
  void add_fan(std::size_t left) {
    const auto first = static_cast<std::uint32_t>(std::ranges::find(gone_, false) - gone_.begin());
    for (std::uint32_t i = after_[first]; left >= 3; --left, i = after_[i]) add(first, i, after_[i]);
  }
};

std::vector<std::string> list_words(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  return {std::istream_iterator<std::string>(stream), {}};
}

bool is_big_face(const std::string& line) {
  if (line.size() < 2 * kManyCorners) return false;
  const std::vector<std::string> words = list_words(line);
  return words.size() > kManyCorners && words.front() == "f";
}

bool has_big_face(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (is_big_face(line)) return true;
  return false;
}

std::vector<glm::dvec3> list_vertices(const std::string& text) {
  std::vector<glm::dvec3> vertices;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> words = list_words(line);
    if (words.size() < 4 || words.front() != "v") continue;
    const auto number = [&](std::size_t i) { return std::strtod(words[i].c_str(), nullptr); };
    vertices.emplace_back(number(1), number(2), number(3));
  }
  return vertices;
}

/// The places of a face's corners; an index below 0 counts back from the `known` vertices before the face.
std::vector<glm::dvec3> find_corners(const std::vector<std::string>& words, const std::vector<glm::dvec3>& vertices,
                                     std::size_t known, const std::string& where) {
  std::vector<glm::dvec3> corners;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const long index = std::strtol(words[i].c_str(), nullptr, 10);
    const long at = index < 0 ? static_cast<long>(known) + index : index - 1;
    if (at < 0 || static_cast<std::size_t>(at) >= vertices.size())
      fail_input(fmt::format("a face uses vertex {}, but there are {}", index, vertices.size()), where);
    corners.push_back(vertices[static_cast<std::size_t>(at)]);
  }
  return corners;
}

std::string write_triangles(const std::vector<std::string>& words, const std::vector<glm::dvec3>& corners) {
  const std::vector<std::uint32_t> triangles = triangulate(corners);
  std::string lines;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
    lines +=
        fmt::format("f {} {} {}\n", words[triangles[i] + 1], words[triangles[i + 1] + 1], words[triangles[i + 2] + 1]);
  return lines;
}

}  // namespace

std::vector<std::uint32_t> triangulate(const std::vector<glm::dvec3>& corners) {
  return corners.size() < 3 ? std::vector<std::uint32_t>() : EarClipper(flatten(corners)).clip();
}

std::string split_big_faces(std::string text, const std::string& where) {
  if (!has_big_face(text)) return text;
  const std::vector<glm::dvec3> vertices = list_vertices(text);
  std::string split, line;
  std::istringstream lines(text);
  std::size_t known = 0;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string> words = list_words(line);
    known += !words.empty() && words.front() == "v" ? 1 : 0;
    split += is_big_face(line)
                 ? write_triangles(words, find_corners(words, vertices, known, fmt::format("{}:{}", where, number)))
                 : line + "\n";
  }
  return split;
}

}  // namespace shadowbench::scene
