// Judges a surface: repairs what can be meant in one way only, and refuses what cannot be filled, with the reason and
// the place. Every decision is exact; measures (area, volume) are rounded as usual.
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "exact.hpp"
#include "mesh.hpp"

namespace ogive::geometry {
namespace {

constexpr double kNoVolume = 1e-14;  // of the sum of magnitudes: below, a shell's volume is rounding
constexpr double kLeastVolume = 1e-290;  // below, parts of it have no longer all digits of a number

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A sum whose rounding does not grow with the number of terms (Neumaier 1974).
class Sum {
 public:
  void add(double x) {
    const double t = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
    sum_ = t;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

struct Shell {
  std::vector<int32_t> facets;
  Vec3 lower, upper;
  double volume = 0;               // signed, as the facets stand
  bool as_read = true;             // no facet had to be turned to agree with its neighbours
  std::vector<int32_t> inside_of;  // the shells that enclose it
  bool is_cavity() const { return inside_of.size() % 2 == 1; }
};

class Checker {
 public:
  Checker(Surface& surface, const std::string& source, ogive_mesh_info& info, std::string& report)
      : s_(surface), source_(source), info_(info), report_(report) {}

  void run() {
    drop_degenerate();
    drop_duplicates();
    if (s_.facets.empty()) refuse("no facet is left; expected a closed surface");
    refuse_if_any("");
    link_edges();
    find_open_and_crowded_edges();
    refuse_if_any("the facets were not tested for intersections because the surface is not closed");
    turned_.assign(s_.facets.size(), false);
    find_shells();
    find_touching_vertices();
    refuse_if_any("the facets were not tested for intersections because of this");
    remove_flat_facets();
    refuse_if_any("the facets were not tested for intersections because of this");
    find_intersections();
    measure_shells();
    refuse_if_any("");
    nest_shells();
    orient_shells();
    refuse_if_any("");
    conclude();
  }

 private:
  struct Edge {
    int32_t low, high;  // vertices
    int32_t corner;     // 3 f + c: the edge runs from corner c of facet f to the next
    bool operator<(const Edge& o) const { return std::tie(low, high, corner) < std::tie(o.low, o.high, o.corner); }
  };

  int32_t facet_count() const { return static_cast<int32_t>(s_.facets.size()); }
  int32_t vertex_at(int32_t corner) const { return s_.facets[corner / 3][corner % 3]; }
  static int32_t next(int32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static int32_t previous(int32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  const Vec3& place(int32_t vertex) const { return s_.vertices[vertex]; }

  std::string name(int32_t facet) const { return "facet " + std::to_string(s_.number[facet]); }
  std::string at(int32_t facet) const {
    const Corners& f = s_.facets[facet];
    Vec3 middle;
    for (int d = 0; d < 3; ++d) middle[d] = (place(f[0])[d] + place(f[1])[d] + place(f[2])[d]) / 3;
    return name(facet) + " at " + text_of(middle);
  }
  std::string between(const Edge& e) const {
    return "between " + text_of(place(e.low)) + " and " + text_of(place(e.high)) + ", " + name(e.corner / 3);
  }

  void repaired(const std::string& line) { report_ += "repaired: " + line + "\n"; }
  void refuse(const std::string& reason) {
    report_ += "refused: " + reason + "\n";
    if (first_reason_.empty()) first_reason_ = reason;
  }
  void refuse_if_any(const std::string& note) {
    if (first_reason_.empty()) return;
    if (!note.empty()) report_ += note + "\n";
    throw Refusal(OGIVE_ERROR_FORMAT, source_ + ": " + first_reason_);
  }

  void drop(const std::vector<bool>& dropped) {
    size_t kept = 0;
    for (size_t f = 0; f < s_.facets.size(); ++f) {
      if (dropped[f]) continue;
      s_.facets[kept] = s_.facets[f];
      s_.number[kept++] = s_.number[f];
    }
    s_.facets.resize(kept);
    s_.number.resize(kept);
  }

  // A facet with a corner twice covers nothing, and its other two edges run to and fro: without it they are each
  // other's mates.
  void drop_degenerate() {
    std::vector<bool> dropped(s_.facets.size(), false);
    std::string first;
    for (int32_t f = 0; f < facet_count(); ++f) {
      const Corners& c = s_.facets[f];
      if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) continue;
      dropped[f] = true;
      if (info_.dropped_degenerate++ == 0) first = at(f);
    }
    if (info_.dropped_degenerate == 0) return;
    drop(dropped);
    repaired(text_of_count(info_.dropped_degenerate, "facet") + " with a corner twice dropped, the first is " + first);
  }

  void drop_duplicates() {
    std::vector<std::pair<Corners, int32_t>> sorted(s_.facets.size());
    for (int32_t f = 0; f < facet_count(); ++f) {
      sorted[f] = {s_.facets[f], f};
      std::sort(sorted[f].first.begin(), sorted[f].first.end());
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<bool> dropped(s_.facets.size(), false);
    int32_t first = std::numeric_limits<int32_t>::max();
    for (size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first != sorted[i - 1].first) continue;
      dropped[sorted[i].second] = true;
      first = std::min(first, sorted[i].second);
      ++info_.dropped_duplicate;
    }
    if (info_.dropped_duplicate == 0) return;
    const std::string place = at(first);
    drop(dropped);
    repaired(text_of_count(info_.dropped_duplicate, "facet") + " given before dropped, the first is " + place);
  }

  // Fills edges_ (sorted) and mate_: for each corner's edge the corner of the neighbour's same edge, -1 if there is not
  // exactly one neighbour.
  void link_edges() {
    edges_.resize(3 * s_.facets.size());
    for (size_t i = 0; i < edges_.size(); ++i) {
      const auto corner = static_cast<int32_t>(i);
      const auto [low, high] = std::minmax({vertex_at(corner), vertex_at(next(corner))});
      edges_[i] = {low, high, corner};
    }
    std::sort(edges_.begin(), edges_.end());
    mate_.assign(edges_.size(), -1);
    for_each_edge([&](size_t begin, size_t end) {
      if (end - begin != 2) return;
      mate_[edges_[begin].corner] = edges_[begin + 1].corner;
      mate_[edges_[begin + 1].corner] = edges_[begin].corner;
    });
  }

  // Calls f(begin, end) for the range in edges_ of each edge.
  template <class F>
  void for_each_edge(F f) const {
    for (size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      end = begin + 1;
      while (end < edges_.size() && edges_[end].low == edges_[begin].low && edges_[end].high == edges_[begin].high)
        ++end;
      f(begin, end);
    }
  }

  void find_open_and_crowded_edges() {
    const Edge* open = nullptr;
    const Edge* crowded = nullptr;
    size_t most = 0;
    for_each_edge([&](size_t begin, size_t end) {
      if (end - begin == 1 && info_.open_edges++ == 0) open = &edges_[begin];
      if (end - begin > 2 && info_.crowded_edges++ == 0) crowded = &edges_[begin], most = end - begin;
    });
    if (open) {
      refuse("not closed: " + text_of_count(info_.open_edges, "edge") + " of one facet, the first " + between(*open) +
             "; expected two facets at each edge");
    }
    if (crowded) {
      refuse(text_of_count(info_.crowded_edges, "edge") + " of more than two facets, the first has " +
             std::to_string(most) + ", " + between(*crowded) + "; expected two facets at each edge");
    }
  }

  void turn(int32_t facet) {
    std::swap(s_.facets[facet][1], s_.facets[facet][2]);
    turned_[facet] = !turned_[facet];
  }

  // Collects the facets that hang together by edges, and turns them to agree with the first of them.
  void find_shells() {
    s_.shell.assign(s_.facets.size(), -1);
    std::vector<int32_t> waiting;
    int32_t contradiction = -1;
    for (int32_t seed = 0; seed < facet_count(); ++seed) {
      if (s_.shell[seed] >= 0) continue;
      const auto number = static_cast<int32_t>(shells_.size());
      Shell& shell = shells_.emplace_back();
      s_.shell[seed] = number;
      waiting.assign(1, seed);
      while (!waiting.empty()) {
        const int32_t f = waiting.back();
        waiting.pop_back();
        shell.facets.push_back(f);
        for (int c = 0; c < 3; ++c) {
          const auto [g, agrees] = neighbour(f, c);
          if (s_.shell[g] < 0) {
            s_.shell[g] = number;
            if (!agrees) turn(g), shell.as_read = false;
            waiting.push_back(g);
          } else if (!agrees && contradiction < 0) {
            contradiction = f;
          }
        }
      }
    }
    if (contradiction >= 0) {
      refuse("one-sided: the facets cannot all face outwards, as seen at " + at(contradiction) +
             "; expected a surface with an inside");
    }
    link_edges();
  }

  // While facets are being turned, mate_ keeps the corners as they were linked; edges are therefore found by their
  // vertices.
  std::pair<int32_t, bool> neighbour(int32_t f, int c) const {
    const int32_t from = s_.facets[f][c], to = s_.facets[f][(c + 1) % 3];
    const int32_t linked = 3 * f + (turned_[f] ? 2 - c : c);  // corners 1 and 2 swapped: edge 0 <-> 2, edge 1 stays
    const int32_t g = mate_[linked] / 3;
    for (int k = 0; k < 3; ++k) {
      if (s_.facets[g][k] == to && s_.facets[g][(k + 1) % 3] == from) return {g, true};
    }
    return {g, false};
  }

  // The facets round a vertex must form one ring; two rings are parts that only touch there.
  void find_touching_vertices() {
    std::vector<int32_t> facets_at(s_.vertices.size(), 0), start(s_.vertices.size(), -1);
    for (int32_t corner = 0; corner < 3 * facet_count(); ++corner) {
      ++facets_at[vertex_at(corner)];
      start[vertex_at(corner)] = corner;
    }
    int32_t first = -1;
    for (size_t v = 0; v < start.size(); ++v) {
      if (start[v] < 0) continue;
      int32_t ring = 0;
      int32_t corner = start[v];
      do {
        // Across the edge that arrives at v; in the neighbour the same edge leaves from v.
        corner = mate_[previous(corner)];
        ++ring;
      } while (corner != start[v] && ring <= facets_at[v]);
      if (ring != facets_at[v] && info_.touching_vertices++ == 0) first = static_cast<int32_t>(v);
    }
    if (first >= 0) {
      refuse(text_of_count(info_.touching_vertices, "point") + " where parts of the surface only touch, the first at " +
             text_of(place(first)) + "; expected one ring of facets round each vertex");
    }
  }

  bool is_flat(int32_t f) const {
    const Corners& c = s_.facets[f];
    return CGAL::collinear(exact_point(place(c[0])), exact_point(place(c[1])), exact_point(place(c[2])));
  }
  bool has_edge(int32_t a, int32_t b) const {
    const Edge wanted = {std::min(a, b), std::max(a, b), 0};
    const auto at = std::lower_bound(edges_.begin(), edges_.end(), wanted);
    return at != edges_.end() && at->low == wanted.low && at->high == wanted.high;
  }

  // A flat facet a b c with c between a and b, and its neighbour b a d, cover what a d c and d b c cover: exactly the
  // neighbour. So exchanging them repairs the facet and leaves the surface where it is. One such exchange may unblock
  // another.
  void remove_flat_facets() {
    std::string first;
    for (;;) {
      std::vector<int32_t> flat;
      for (int32_t f = 0; f < facet_count(); ++f) {
        if (is_flat(f)) flat.push_back(f);
      }
      if (flat.empty()) break;
      std::set<std::pair<int32_t, int32_t>> added;
      std::set<int32_t> touched;
      const int64_t removed_before = info_.removed_flat;
      for (const int32_t f : flat) {
        if (first.empty()) first = at(f);
        int32_t longest = 3 * f;
        while (!CGAL::collinear_are_strictly_ordered_along_line(exact_point(place(vertex_at(longest))),
                                                                exact_point(place(vertex_at(previous(longest)))),
                                                                exact_point(place(vertex_at(next(longest)))))) {
          ++longest;
        }
        const int32_t a = vertex_at(longest), b = vertex_at(next(longest)), c = vertex_at(previous(longest));
        const int32_t g = mate_[longest] / 3;
        const int32_t d = vertex_at(previous(mate_[longest]));
        if (is_flat(g) || touched.count(f) || touched.count(g) || has_edge(c, d)) continue;
        if (!added.insert(std::minmax(c, d)).second) continue;
        touched.insert({f, g});
        s_.facets[f] = {a, d, c};
        s_.facets[g] = {d, b, c};
        s_.number[f] = s_.number[g];
        ++info_.removed_flat;
      }
      if (info_.removed_flat == removed_before) {
        refuse(text_of_count(static_cast<int64_t>(flat.size()), "facet") +
               " with three corners on one line that cannot be " + "removed, the first is " + at(flat[0]) +
               "; expected facets with an area");
        return;
      }
      link_edges();
    }
    if (info_.removed_flat > 0) {
      repaired(text_of_count(info_.removed_flat, "facet") + " with three corners on one line removed, the first is " +
               first);
    }
  }

  void find_intersections() {
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    using Index = Mesh::Face_index;
    Mesh mesh;
    for (const Vec3& p : s_.vertices) mesh.add_vertex(exact_point(p));
    for (const Corners& f : s_.facets) {
      const auto v = [&](int c) { return Mesh::Vertex_index(static_cast<uint32_t>(f[c])); };
      if (mesh.add_face(v(0), v(1), v(2)) == Mesh::null_face()) {
        throw Refusal(OGIVE_ERROR_INTERNAL, source_ + ": a facet of a closed surface could not be linked");
      }
    }
    // Their number and the first in order, whatever order they come in; a list of them could need any amount of memory.
    std::pair<Index, Index> first;
    const auto take = [&](const std::pair<Index, Index>& found) {
      const std::pair<Index, Index> pair = std::minmax(found.first, found.second);
      if (info_.intersecting_pairs++ == 0 || pair < first) first = pair;
    };
    CGAL::Polygon_mesh_processing::self_intersections(faces(mesh), mesh, boost::make_function_output_iterator(take));
    if (info_.intersecting_pairs > 0) {
      refuse(text_of_count(info_.intersecting_pairs, "pair") + " of facets that intersect, the first is " +
             at(static_cast<int32_t>(first.first)) + " with " + at(static_cast<int32_t>(first.second)) +
             "; expected a surface that does not meet itself");
    }
  }

  void measure_shells() {
    for (Shell& shell : shells_) {
      const Vec3& origin = place(s_.facets[shell.facets[0]][0]);
      shell.lower = shell.upper = origin;
      Sum volume;
      double magnitude = 0;
      for (const int32_t f : shell.facets) {
        const Corners& c = s_.facets[f];
        const double part =
            dot(minus(place(c[0]), origin), cross(minus(place(c[1]), origin), minus(place(c[2]), origin))) / 6;
        volume.add(part);
        magnitude += std::abs(part);
        for (const int32_t v : c) {
          for (int d = 0; d < 3; ++d) {
            shell.lower[d] = std::min(shell.lower[d], place(v)[d]);
            shell.upper[d] = std::max(shell.upper[d], place(v)[d]);
          }
        }
      }
      shell.volume = volume.value();
      if (!(std::abs(shell.volume) > std::max(kNoVolume * magnitude, kLeastVolume))) {
        refuse("the shell of " + at(shell.facets[0]) + " encloses no volume");
      }
    }
  }

  // Shells do not intersect by now, so one vertex tells where the whole shell is.
  bool encloses(const Shell& outer, const Vec3& p) const {
    for (int d = 0; d < 3; ++d) {
      if (p[d] < outer.lower[d] || p[d] > outer.upper[d]) return false;
    }
    int winding = 0;
    for (const int32_t f : outer.facets) {
      const Vec3& a = place(s_.facets[f][0]);
      const Vec3& b = place(s_.facets[f][1]);
      const Vec3& c = place(s_.facets[f][2]);
      const int turn = turn_seen_from_z(a, b, c);
      // One of the moved lines is enough here: p is not on the surface.
      if (turn == 0 || !(passes(a, b, c, turn, p[0], p[1]) & kMoved)) continue;
      if (height_over(a, b, c, turn, p) > 0) winding -= turn;
    }
    return winding != 0;
  }

  void nest_shells() {
    for (size_t i = 0; i < shells_.size(); ++i) {
      const Vec3& p = place(s_.facets[shells_[i].facets[0]][0]);
      for (size_t j = 0; j < shells_.size(); ++j) {
        if (j != i && encloses(shells_[j], p)) shells_[i].inside_of.push_back(static_cast<int32_t>(j));
      }
    }
  }

  // Outermost shells face outwards; that is all they can mean. A shell inside must say by facing the other way than
  // what is round it that it is a cavity: were it turned silently, a core in a jacket would become a hole, or a hole a
  // core.
  void orient_shells() {
    for (Shell& shell : shells_) {
      const bool faces_out = shell.volume > 0;
      if (!shell.inside_of.empty()) {
        const Shell* outermost = nullptr;
        for (const int32_t j : shell.inside_of) {
          if (shells_[j].inside_of.empty()) outermost = &shells_[j];
        }
        // A file that is inside out as a whole stays consistent in itself. (Outermost shells may be turned already.)
        const bool file_is_inverted = outermost->as_read && turned_[outermost->facets[0]] != (outermost->volume < 0);
        const bool faced_out = faces_out != file_is_inverted;
        if (!shell.as_read || faced_out == shell.is_cavity()) {
          refuse("the shell of " + at(shell.facets[0]) + " lies inside the shell of " + at(outermost->facets[0]) +
                 " and " +
                 (shell.as_read ? std::string("faces ") + (faced_out ? "outwards" : "inwards")
                                : std::string("its facets face both ways")) +
                 "; expected it to face " +
                 (shell.is_cavity() ? "inwards, as a cavity" : "outwards, as a solid in a cavity"));
          continue;
        }
      }
      if (faces_out == shell.is_cavity()) {
        for (const int32_t f : shell.facets) turn(f);
        shell.volume = -shell.volume;
      }
    }
  }

  void conclude() {
    info_.turned = std::count(turned_.begin(), turned_.end(), true);
    if (info_.turned == facet_count()) {
      repaired("inside out: all " + text_of_count(info_.turned, "facet") + " turned");
    } else if (info_.turned > 0) {
      const auto first = std::find(turned_.begin(), turned_.end(), true) - turned_.begin();
      repaired(text_of_count(info_.turned, "facet") + " turned, the first is " + at(static_cast<int32_t>(first)));
    }
    Sum volume;
    for (const Shell& shell : shells_) {
      volume.add(shell.volume);
      if (shell.is_cavity()) ++info_.cavities;
    }
    info_.shells = static_cast<int32_t>(shells_.size());
    info_.volume = volume.value();
    keep_used_vertices();
    measure_surface(s_, info_);
    report_ += "closed, without intersections: " + text_of_count(info_.facets, "facet") + ", " +
               std::to_string(info_.vertices) + " vertices, " + text_of_count(info_.shells, "shell");
    if (info_.cavities > 0)
      report_ += ", of them " + std::to_string(info_.cavities) + (info_.cavities == 1 ? " cavity" : " cavities");
    report_ += "\nvolume " + text_of(info_.volume, 12) + ", area " + text_of(info_.area, 12) + "\nbounding box " +
               text_of(Vec3{info_.lower[0], info_.lower[1], info_.lower[2]}) + " to " +
               text_of(Vec3{info_.upper[0], info_.upper[1], info_.upper[2]}) + "\n";
  }

  // Dropped facets may leave vertices of no facet.
  void keep_used_vertices() {
    std::vector<int32_t> renumbered(s_.vertices.size(), -1);
    for (const Corners& f : s_.facets) {
      for (const int32_t v : f) renumbered[v] = 0;
    }
    int32_t kept = 0;
    for (size_t v = 0; v < renumbered.size(); ++v) {
      if (renumbered[v] < 0) continue;
      s_.vertices[kept] = s_.vertices[v];
      renumbered[v] = kept++;
    }
    s_.vertices.resize(kept);
    for (Corners& f : s_.facets) {
      for (int32_t& v : f) v = renumbered[v];
    }
  }

  Surface& s_;
  const std::string& source_;
  ogive_mesh_info& info_;
  std::string& report_;
  std::string first_reason_;
  std::vector<Edge> edges_;
  std::vector<int32_t> mate_;
  std::vector<bool> turned_;
  std::vector<Shell> shells_;
};

}  // namespace

void check_surface(Surface& surface, const std::string& source, ogive_mesh_info& info, std::string& report) {
  Checker(surface, source, info, report).run();
}

void measure_surface(const Surface& surface, ogive_mesh_info& info) {
  info.facets = static_cast<int64_t>(surface.facets.size());
  info.vertices = static_cast<int64_t>(surface.vertices.size());
  Sum area;
  for (const Corners& f : surface.facets) {
    const Vec3& a = surface.vertices[f[0]];
    const Vec3 normal = cross(minus(surface.vertices[f[1]], a), minus(surface.vertices[f[2]], a));
    area.add(std::sqrt(dot(normal, normal)) / 2);
  }
  info.area = area.value();
  for (int d = 0; d < 3; ++d) {
    info.lower[d] = info.upper[d] = surface.vertices[0][d];
    for (const Vec3& p : surface.vertices) {
      info.lower[d] = std::min(info.lower[d], p[d]);
      info.upper[d] = std::max(info.upper[d], p[d]);
    }
  }
}

}  // namespace ogive::geometry
