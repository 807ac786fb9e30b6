// Refinement: a queue of triangles of insufficient quality, worst first; for each the caller proposes a new vertex. Based on: Ruppert 1995, Rebay 1993.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {

/// Queue of triangles by priority, in classes of an eighth of an octave; first in, first out within a class. All operations in constant time.
class RefineQueue {
 public:
  struct Entry {
    TriangleId triangle;
    std::uint32_t stamp;  ///< stamp of the triangle when it was added: an entry is void if the triangle has changed since
  };
  RefineQueue() : classes_(k_classes) {}
  /// \pre priority > 0
  void push(double priority, Entry entry) {
    // Exponent and the first three bits of the fraction.
    const std::size_t c = std::bit_cast<std::uint32_t>(static_cast<float>(std::min(priority, 1e30))) >> 20;
    classes_[c].entries.push_back(entry);
    top_ = std::max(top_, c);
  }
  /// \return false when empty
  bool pop(Entry& entry) {
    for (;; --top_) {
      Class& c = classes_[top_];
      if (c.first < c.entries.size()) {
        entry = c.entries[c.first++];
        return true;
      }
      c.entries.clear();
      c.first = 0;
      if (top_ == 0) return false;
    }
  }

 private:
  static constexpr std::size_t k_classes = 2048;
  struct Class {
    std::vector<Entry> entries;
    std::size_t first = 0;
  };
  std::vector<Class> classes_;
  std::size_t top_ = 0;
};

struct RefineReport {
  std::size_t n_inserted = 0;
  std::size_t n_too_near = 0;  ///< proposals rejected, by reason
  std::size_t n_beyond_border = 0;
  std::size_t n_folded = 0;
  bool is_limit_met = false;  ///< stopped at `max_insertions`; the remaining triangles are not refined
};

struct Proposal {
  Uv at;
  SurfaceSample sample;
  double min_distance = 0.0;  ///< metres: the proposal is rejected if nearer to a vertex around its cavity
  double size = 0.0;          ///< user data of the task, not used by refine
};

/// Inserts vertices until no triangle has a priority, all proposals are rejected, or the limit is reached. A rejected proposal is not repeated until its
/// neighbourhood has changed, so the refinement terminates.
/// A Task has four functions. `void measure(surface, t)` is called if t is new or has changed, or one of its corners is new, always before any priority() of t
/// and of its neighbours. `double priority(surface, t)` is not positive if t is good or cannot be improved; it is never called for flat triangles. `bool
/// propose(surface, t, Proposal&)` returns false if it has no proposal. `void inserted(surface, p, proposal)` is called after an insertion.
/// The `Criterion` is that of insert_vertex. With `Flips`, edges are flipped to the 3-D criterion after each insertion.
template <bool Flips, class Criterion, class Task>
RefineReport refine(SurfaceTriangulation& surface, const Criterion& criterion, Task& task, std::size_t max_insertions, const RunContext& context) {
  constexpr std::size_t k_stop_interval = 4096;
  Triangulation& mesh = surface.mesh;
  RefineReport report;
  RefineQueue queue;
  Column<TriangleId, std::uint32_t> waiting(mesh.cells.size(), 0);  // stamp + 1 of the triangle's entry in the queue
  const auto consider = [&](TriangleId t) {
    if (surface.is_flat(t)) return;
    const std::uint32_t stamp = mesh.cells[t].stamp;
    if (waiting[t] == stamp + 1) return;
    const double priority = task.priority(surface, t);
    if (!(priority > 0.0)) return;
    waiting[t] = stamp + 1;
    queue.push(priority, {t, stamp});
  };
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead) task.measure(surface, t);
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead) consider(t);
  Cavity cavity;
  std::vector<HalfedgeId> to_flip, star;
  std::vector<TriangleId> touched;
  RefineQueue::Entry entry;
  Proposal proposal;
  while (queue.pop(entry)) {
    const TriangleId t = entry.triangle;
    if (mesh.cells[t].is_dead || mesh.cells[t].stamp != entry.stamp) continue;
    waiting[t] = 0;
    if (!(task.priority(surface, t) > 0.0) || !task.propose(surface, t, proposal)) continue;
    if (report.n_inserted >= max_insertions) {
      report.is_limit_met = true;
      break;
    }
    const InsertOutcome outcome = insert_vertex(surface, proposal.at, proposal.sample, t, proposal.min_distance, criterion, cavity);
    if (outcome != InsertOutcome::inserted) {
      ++(outcome == InsertOutcome::too_near ? report.n_too_near : outcome == InsertOutcome::beyond_border ? report.n_beyond_border : report.n_folded);
      continue;
    }
    if (++report.n_inserted % k_stop_interval == 0) context.check_stop();
    const VertexId p(static_cast<std::uint64_t>(mesh.uv.size() - 1));
    task.inserted(surface, p, proposal);
    waiting.resize(mesh.cells.size(), 0);
    touched.clear();
    if constexpr (Flips) {
      to_flip.clear();
      for (const TriangleId s : cavity.triangles) to_flip.push_back(halfedge(s, 0));
      flip_around(surface, to_flip, touched);
    }
    star.clear();
    for_star(mesh, p, [&](HalfedgeId h) { star.push_back(h); });
    for (const TriangleId s : touched) task.measure(surface, s);
    for (const HalfedgeId h : star) task.measure(surface, triangle_of(h));
    for (const TriangleId s : touched) consider(s);
    for (const HalfedgeId h : star) {
      consider(triangle_of(h));
      if (const HalfedgeId out = mesh.twin(next(h)); out.is_valid()) consider(triangle_of(out));
    }
  }
  return report;
}

}  // namespace sterna::delaunay
