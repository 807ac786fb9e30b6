// Stages of a case in a series with a reference. The reference itself stores them; the other cases start from them if that is proved to be valid.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/kept_reference.h"
#include "scripting/values/mesh_parts.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/parts/makers.h"

namespace sterna::scripting {

/// Returns `ordinary` with two changes: parts that are deformed parts of the reference take over its triangles (surfmesh::carry_mesh), and the reference's own
/// triangles are stored. A part is meshed by `ordinary` if its geometry is the reference's. It is also meshed by `ordinary`, which is reported, if its
/// structure, its options, or sizes by location differ, or if the mesh taken over would not be good. \param key key of the result of `ordinary`, for the cache;
/// may be empty
PartMesher starting_mesher(const Reuse& reuse, const PartMesher& ordinary,
                           const std::function<std::optional<ContentKey>(const PartTask&, const RunContext&)>& key = {});

/// Returns makers of envelopes. An envelope starts from the reference's if the wall has the reference's triangles (volmesh::warm_start); the reference's own
/// envelopes are stored. In all other cases `ordinary` makes the envelope of a part, under `key` in the cache.
/// \pre reuse.reference
volmesh::Makers starting_envelopes(volmesh::Makers makers, const Reuse& reuse, const volmesh::PartEnvelopeMaker& ordinary,
                                   const std::function<ContentKey(const volmesh::PartEnvelopeTask&, const RunContext&)>& key);

/// Reports, for each part of a wall that took over triangles and whose envelope was not requested, why that envelope did not start from the reference's. To be
/// called after the wall's envelope was made.
void report_other_envelopes(const std::vector<volmesh::PlacedPart>& parts, const Reuse& reuse, const RunContext& context);

/// Returns the key of a result that also depends on the reference; without a reference the key is unchanged.
std::optional<ContentKey> beside_reference(const std::optional<ContentKey>& key, const Reuse& reuse, const RunContext& context);

/// Does the same as cached() of stage_cache.h for a result beside which data is stored or reported (ReferenceUse): a result from the cache restores the same
/// data. \p key does not include the reference
template <class T>
T cached_with_reference(const Reuse& reuse, std::string_view stage, std::string_view what, const std::optional<ContentKey>& key, const RunContext& context,
                        const std::function<T()>& make, const std::function<bool(const T&)>& may_keep = {});

void write_beside(ByteSink& sink, const ReferenceUse::Beside& beside);
ReferenceUse::Beside read_beside(ByteSource& source);

template <class T>
T cached_with_reference(const Reuse& reuse, std::string_view stage, std::string_view what, const std::optional<ContentKey>& key, const RunContext& context,
                        const std::function<T()>& make, const std::function<bool(const T&)>& may_keep) {
  if (reuse.reference == nullptr) return cached<T>(reuse, stage, what, key, context, make, may_keep);
  ReferenceUse& reference = *reuse.reference;
  const ReferenceUse::Mark mark = reference.mark();
  std::optional<ReferenceUse::Beside> found;
  const auto make_here = [&] {
    found.reset();  // the data of the entry are damaged
    return make();
  };
  const auto write = [&](ByteSink& sink, const T& value) {
    write_value(sink, value);
    write_beside(sink, reference.since(mark));
  };
  const auto read = [&](ByteSource& source) {
    T value;
    read_value(source, value);
    found = read_beside(source);
    return value;
  };
  T value = cached<T>(reuse, stage, what, beside_reference(key, reuse, context), context, std::function<T()>(make_here), write,
                      std::function<T(ByteSource&)>(read), may_keep);
  if (found) reference.take(std::move(*found), reuse, context);
  return value;
}

}  // namespace sterna::scripting
