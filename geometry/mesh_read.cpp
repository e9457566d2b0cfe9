// Reads surfaces from STL and OFF files and from arrays. Everything in a file is doubted: counts are held against the
// file's length before memory is taken, and each refusal names the line, or the facet and corner.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <unordered_map>

#include "mesh.hpp"

namespace ogive::geometry {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies in memory");

constexpr size_t kStlHeader = 84;         // 80 bytes of anything and the facet count
constexpr size_t kStlFacet = 50;          // normal, three corners, two bytes of anything
constexpr size_t kShortestOffVertex = 6;  // "0 0 0\n"
constexpr size_t kShortestOffFacet = 8;   // "3 0 1 2\n"
constexpr double kFlatness = 1e-6;        // of an OFF facet's size: what its corners may lie off their common plane

[[noreturn]] void refuse_file(const std::string& path, const std::string& why) {
  throw Refusal(OGIVE_ERROR_FILE, path + ": " + why);
}
[[noreturn]] void refuse_format(const std::string& where, const std::string& why) {
  throw Refusal(OGIVE_ERROR_FORMAT, where + ": " + why);
}

std::string read_file(const std::string& path) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error).type();
  if (kind == std::filesystem::file_type::not_found) refuse_file(path, "there is no such file");
  if (error) refuse_file(path, "cannot be read: " + error.message());
  if (kind != std::filesystem::file_type::regular) refuse_file(path, "is not a file: expected an STL or OFF file");
  const auto size = std::filesystem::file_size(path, error);
  if (error) refuse_file(path, "cannot be read: " + error.message());

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) refuse_file(path, "cannot be opened: " + std::generic_category().message(errno));
  std::string bytes(size, '\0');
  if (std::fread(bytes.data(), 1, size, file.get()) != size) refuse_file(path, "cannot be read to its end");
  return bytes;
}

// Collects corners into distinct vertices.
class Builder {
 public:
  // status: what a refused coordinate is, a fault of a file or of an argument.
  Builder(const std::string& source, double scale, ogive_status status)
      : source_(source), scale_(scale), status_(status) {}

  // The number of a vertex with these coordinates; `where` is asked for the place only if they are refused.
  template <class Where>
  int32_t vertex(const Vec3& raw, Where where) {
    Vec3 p;
    for (int d = 0; d < 3; ++d) {
      p[d] = raw[d] * scale_ + 0.0;  // turns -0 into 0, so that equal coordinates have equal bits
      if (!(std::abs(p[d]) <= kLargestCoordinate)) {
        throw Refusal(status_, where() + ": coordinate " + "xyz"[d] + " = " + text_of(p[d]) +
                                   ": expected a number of magnitude up to 1e100");
      }
    }
    const auto [at, added] = index_.try_emplace(p, static_cast<int32_t>(result_.surface.vertices.size()));
    if (added) result_.surface.vertices.push_back(p);
    return at->second;
  }

  void facet(const Corners& corners, int64_t number) {
    if (static_cast<int64_t>(result_.surface.facets.size()) >= kMostFacets) {
      refuse_format(source_, "more than " + std::to_string(kMostFacets) + " triangles");
    }
    result_.surface.facets.push_back(corners);
    result_.surface.number.push_back(static_cast<int32_t>(number));
  }

  const std::vector<Vec3>& vertices() const { return result_.surface.vertices; }
  const std::string& source() const { return source_; }

  // `kind` opens the report: "binary STL", ...
  ReadSurface finish(const std::string& kind) {
    Surface& surface = result_.surface;
    if (surface.facets.empty()) refuse_format(source_, "holds no facets: expected a closed surface");
    drop_unused_vertices();
    result_.source = source_;
    result_.report = source_ + ": " + kind + ", " +
                     text_of_count(static_cast<int64_t>(surface.facets.size()), "triangle") + ", " +
                     std::to_string(surface.vertices.size()) + " distinct vertices\n";
    if (scale_ != 1) result_.report += "coordinates multiplied by " + text_of(scale_) + "\n";
    return std::move(result_);
  }

 private:
  struct Hash {
    size_t operator()(const Vec3& p) const {
      uint64_t h = 0;
      for (double x : p) h = (h ^ std::bit_cast<uint64_t>(x)) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
      return h;
    }
  };

  // OFF files may list vertices that no facet has.
  void drop_unused_vertices() {
    Surface& s = result_.surface;
    std::vector<int32_t> renumbered(s.vertices.size(), -1);
    for (const Corners& f : s.facets) {
      for (int32_t v : f) renumbered[v] = 0;
    }
    int32_t kept = 0;
    for (size_t v = 0; v < renumbered.size(); ++v) {
      if (renumbered[v] < 0) continue;
      s.vertices[kept] = s.vertices[v];
      renumbered[v] = kept++;
    }
    s.vertices.resize(kept);
    for (Corners& f : s.facets) {
      for (int32_t& v : f) v = renumbered[v];
    }
  }

  std::string source_;
  double scale_;
  ogive_status status_;
  ReadSurface result_;
  std::unordered_map<Vec3, int32_t, Hash> index_;
};

// Words and numbers of a text file.
class Scanner {
 public:
  Scanner(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  std::string where() const { return path_ + ":" + std::to_string(line_); }

  // The next word on this or a later line; empty at the end.
  std::string_view word() {
    while (at_ < text_.size() && is_space(text_[at_])) advance();
    return rest_of_word();
  }
  // The next word on this line; empty where the line ends or a comment begins.
  std::string_view word_on_line() {
    while (at_ < text_.size() && is_space(text_[at_]) && text_[at_] != '\n') advance();
    if (at_ < text_.size() && text_[at_] == '#') skip_line_content();
    return rest_of_word();
  }
  void skip_line_content() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  // To the next line that holds more than blanks and a comment; false at the end of the text.
  bool to_content() {
    for (;;) {
      while (at_ < text_.size() && is_space(text_[at_])) advance();
      if (at_ >= text_.size()) return false;
      if (text_[at_] != '#') return true;
      skip_line_content();
    }
  }

  double number(std::string_view word, const char* what) const {
    double value = 0;
    const std::string_view digits = unsigned_word(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range)
      refuse_format(where(), quoted(what, word) + ": beyond double precision");
    if (error != std::errc() || end != digits.data() + digits.size()) {
      refuse_format(where(), quoted(what, word) + ": expected a number");
    }
    return value;
  }
  int64_t whole_number(std::string_view word, const char* what) const {
    int64_t value = 0;
    const std::string_view digits = unsigned_word(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < 0) {
      refuse_format(where(), quoted(what, word) + ": expected a whole number >= 0");
    }
    return value;
  }

  static std::string quoted(const std::string& what, std::string_view word) {
    if (word.empty()) return what + " is missing";
    return what + " is \"" + std::string(word.substr(0, 40)) + "\"";
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  // A leading plus is common in files and unknown to from_chars.
  static std::string_view unsigned_word(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
  }
  void advance() {
    if (text_[at_++] == '\n') ++line_;
  }
  std::string_view rest_of_word() {
    const size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  const std::string& path_;
  std::string_view text_;
  size_t at_ = 0;
  int64_t line_ = 1;
};

bool same_word(std::string_view word, std::string_view lower_case) {
  return word.size() == lower_case.size() &&
         std::equal(word.begin(), word.end(), lower_case.begin(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

uint32_t stl_count(std::string_view bytes) {
  uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeader - sizeof count, sizeof count);
  return count;
}

ReadSurface read_binary_stl(std::string_view bytes, Builder& builder) {
  const int64_t count = stl_count(bytes);
  for (int64_t f = 0; f < count; ++f) {
    std::array<float, 9> xyz;
    std::memcpy(xyz.data(), bytes.data() + kStlHeader + f * kStlFacet + 3 * sizeof(float), sizeof xyz);
    Corners corners;
    for (int c = 0; c < 3; ++c) {
      corners[c] = builder.vertex({xyz[3 * c], xyz[3 * c + 1], xyz[3 * c + 2]}, [&] {
        return builder.source() + ": facet " + std::to_string(f) + ", corner " + std::to_string(c);
      });
    }
    builder.facet(corners, f);
  }
  return builder.finish("binary STL");
}

ReadSurface read_ascii_stl(const std::string& path, std::string_view text, Builder& builder) {
  Scanner in(path, text);
  const auto expect = [&](std::string_view word, std::string_view expected) {
    if (!same_word(word, expected)) {
      const std::string found = word.empty() ? "the file ends" : Scanner::quoted("the word", word);
      refuse_format(in.where(), found + ": expected \"" + std::string(expected) + "\"");
    }
  };
  int64_t facets = 0, solids = 0;
  for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
    expect(word, "solid");
    in.skip_line_content();  // the solid's name
    ++solids;
    for (word = in.word(); !same_word(word, "endsolid"); word = in.word()) {
      if (word.empty()) {
        refuse_format(in.where(), "the file ends after " + text_of_count(facets, "facet") +
                                      " inside a solid: expected \"facet\" or \"endsolid\"");
      }
      expect(word, "facet");
      expect(in.word(), "normal");
      for (int d = 0; d < 3; ++d) in.word();
      expect(in.word(), "outer");
      expect(in.word(), "loop");
      Corners corners;
      for (int32_t& corner : corners) {
        expect(in.word(), "vertex");
        Vec3 p;
        for (int d = 0; d < 3; ++d) p[d] = in.number(in.word(), "the vertex coordinate");
        corner = builder.vertex(p, [&] { return in.where(); });
      }
      expect(in.word(), "endloop");
      expect(in.word(), "endfacet");
      builder.facet(corners, facets++);
    }
    in.skip_line_content();
  }
  return builder.finish(solids == 1 ? "ASCII STL" : "ASCII STL, " + text_of_count(solids, "solid"));
}

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Whether the polygon's corners lie in a plane and turn one way once round, so that every way to cut it gives the same
// surface.
bool is_flat_and_convex(const std::vector<Vec3>& vertices, const std::vector<int32_t>& polygon) {
  const size_t n = polygon.size();
  Vec3 normal{};
  double size = 0;
  const Vec3& first = vertices[polygon[0]];
  for (size_t i = 1; i + 1 < n; ++i) {
    const Vec3 part = cross(minus(vertices[polygon[i]], first), minus(vertices[polygon[i + 1]], first));
    for (int d = 0; d < 3; ++d) normal[d] += part[d];
  }
  for (int32_t v : polygon) size = std::max(size, std::sqrt(dot(minus(vertices[v], first), minus(vertices[v], first))));
  const double length = std::sqrt(dot(normal, normal));
  if (!(length > 0)) return false;
  for (double& x : normal) x /= length;
  for (size_t i = 0; i < n; ++i) {
    const Vec3& p = vertices[polygon[i]];
    const Vec3& q = vertices[polygon[(i + 1) % n]];
    const Vec3 inward = cross(normal, minus(q, p));
    // All corners on one side of each edge: also rules out a polygon that winds round twice.
    for (int32_t v : polygon) {
      if (dot(minus(vertices[v], p), inward) < -kFlatness * size * size) return false;
      if (std::abs(dot(minus(vertices[v], p), normal)) > kFlatness * size) return false;
    }
  }
  return true;
}

ReadSurface read_off(const std::string& path, std::string_view text, Builder& builder) {
  Scanner in(path, text);
  const auto next_line = [&](const std::string& expected) {
    in.skip_line_content();
    if (!in.to_content()) refuse_format(in.where(), "the file ends: expected " + expected);
  };
  in.to_content();
  in.word();  // "OFF", seen before
  std::string_view word = in.word_on_line();
  if (same_word(word, "binary")) refuse_format(in.where(), "binary OFF: expected an OFF file in text");
  if (word.empty()) {
    next_line("the numbers of vertices and facets");
    word = in.word_on_line();
  }
  const int64_t vertex_count = in.whole_number(word, "the number of vertices");
  const int64_t facet_count = in.whole_number(in.word_on_line(), "the number of facets");
  // One by one first: the sum of what damaged counts promise could overflow.
  const auto most_vertices = static_cast<int64_t>(text.size() / kShortestOffVertex);
  const auto most_facets = static_cast<int64_t>(text.size() / kShortestOffFacet);
  if (vertex_count > most_vertices || facet_count > most_facets) {
    refuse_format(in.where(), "promises " + std::to_string(vertex_count) + " vertices and " +
                                  text_of_count(facet_count, "facet") + ", more than " +
                                  text_of_count(static_cast<int64_t>(text.size()), "byte") + " can hold");
  }
  if (vertex_count > kMostFacets || facet_count > kMostFacets) {
    refuse_format(in.where(), "more than " + std::to_string(kMostFacets) + " vertices or facets");
  }

  std::vector<int32_t> vertex_of_number(vertex_count);  // the file's numbers to distinct vertices
  for (int64_t v = 0; v < vertex_count; ++v) {
    next_line("vertex " + std::to_string(v) + " of " + std::to_string(vertex_count));
    Vec3 p;
    for (int d = 0; d < 3; ++d) p[d] = in.number(in.word_on_line(), "the vertex coordinate");
    vertex_of_number[v] = builder.vertex(p, [&] { return in.where(); });
  }
  std::vector<int32_t> polygon;
  for (int64_t f = 0; f < facet_count; ++f) {
    next_line("facet " + std::to_string(f) + " of " + std::to_string(facet_count));
    const int64_t corners = in.whole_number(in.word_on_line(), "the number of corners");
    if (corners < 3)
      refuse_format(in.where(), "a facet of " + std::to_string(corners) + " corners: expected at least 3");
    polygon.clear();
    for (int64_t c = 0; c < corners; ++c) {  // the line's end stops a count that lies
      const int64_t v = in.whole_number(in.word_on_line(), "the vertex number");
      if (v >= vertex_count) {
        refuse_format(in.where(), "the vertex number is " + std::to_string(v) + ": expected 0.." +
                                      std::to_string(vertex_count - 1));
      }
      polygon.push_back(vertex_of_number[v]);
    }
    if (corners > 3 && !is_flat_and_convex(builder.vertices(), polygon)) {
      refuse_format(in.where(),
                    "facet " + std::to_string(f) + " of " + std::to_string(corners) +
                        " corners is not flat and convex: expected triangles, or facets that can be cut only one way");
    }
    for (int64_t c = 1; c + 1 < corners; ++c) builder.facet({polygon[0], polygon[c], polygon[c + 1]}, f);
  }
  in.skip_line_content();
  if (in.to_content()) refuse_format(in.where(), "text after the last facet: expected the end of the file");
  return builder.finish("OFF");
}

bool is_off_keyword(std::string_view word) {
  for (std::string_view prefix : {"ST", "C", "N"}) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  }
  return word == "OFF";
}

bool looks_like_text(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  return std::none_of(head.begin(), head.end(),
                      [](unsigned char c) { return (c < ' ' && !(c >= '\t' && c <= '\r')) || c == 127; });
}

}  // namespace

ReadSurface read_surface(const std::string& path, double scale) {
  const std::string bytes = read_file(path);
  Builder builder(path, scale, OGIVE_ERROR_FORMAT);
  if (bytes.empty()) refuse_format(path, "the file is empty: expected an STL or OFF file");

  // The length decides before the header does: many programs begin binary STL with "solid".
  if (bytes.size() >= kStlHeader && bytes.size() == kStlHeader + kStlFacet * static_cast<size_t>(stl_count(bytes))) {
    return read_binary_stl(bytes, builder);
  }
  std::string_view text = bytes;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Scanner head(path, text);
  head.to_content();
  const std::string_view first = head.word();
  const bool is_text = looks_like_text(text);
  if (is_text && same_word(first, "solid")) return read_ascii_stl(path, text, builder);
  if (is_off_keyword(first)) return read_off(path, text, builder);

  const bool named_stl = path.size() >= 4 && same_word(std::string_view(path).substr(path.size() - 4), ".stl");
  if (!is_text && (named_stl || same_word(std::string_view(bytes).substr(0, 5), "solid"))) {
    if (bytes.size() < kStlHeader) {
      refuse_format(path, "cut short: " + text_of_count(static_cast<int64_t>(bytes.size()), "byte") +
                              ", expected at least the 84 with which binary STL begins");
    }
    const int64_t count = stl_count(bytes);
    refuse_format(path, "damaged binary STL: it promises " + text_of_count(count, "facet") + ", that is " +
                            std::to_string(static_cast<int64_t>(kStlHeader) + static_cast<int64_t>(kStlFacet) * count) +
                            " bytes, and has " + std::to_string(bytes.size()));
  }
  refuse_format(path, "neither STL nor OFF: expected a binary STL, or text that begins with \"solid\" or \"OFF\"");
}

ReadSurface surface_from_arrays(int64_t vertex_count, const double* xyz, int64_t facet_count, const int32_t* corners) {
  Builder builder("facets", 1, OGIVE_ERROR_ARGUMENT);
  std::vector<int32_t> vertex_of_number(vertex_count);
  for (int64_t v = 0; v < vertex_count; ++v) {
    vertex_of_number[v] = builder.vertex({xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]},
                                         [&] { return "xyz of vertex " + std::to_string(v); });
  }
  for (int64_t f = 0; f < facet_count; ++f) {
    Corners facet;
    for (int c = 0; c < 3; ++c) {
      const int32_t v = corners[3 * f + c];
      if (v < 0 || v >= vertex_count) {
        throw Refusal(OGIVE_ERROR_ARGUMENT, "corners of facet " + std::to_string(f) + " hold vertex " +
                                                std::to_string(v) + ": expected 0.." +
                                                std::to_string(vertex_count - 1));
      }
      facet[c] = vertex_of_number[v];
    }
    builder.facet(facet, f);
  }
  return builder.finish("from arrays");
}

}  // namespace ogive::geometry
