// Stages of a case in a series with a reference: the reference itself stores them, the other cases start from them if that is proved to be valid.
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

/// Returns `ordinary` with these changes: parts that are deformed parts of the reference take over its triangles (surfmesh::carry_mesh), and the reference's
/// own are stored. In these cases a part is meshed by `ordinary`: its geometry is the reference's; or, which is reported, its structure, its options, or sizes
/// by location differ, or the mesh taken over would not be good. \param key of the result of `ordinary`, for the cache; may be empty
PartMesher starting_mesher(const Reuse& reuse, const PartMesher& ordinary,
                           const std::function<std::optional<ContentKey>(const PartTask&, const RunContext&)>& key = {});

/// Returns makers of envelopes that start from the reference's if the wall has its triangles (volmesh::warm_start), and store the reference's own. `ordinary`
/// makes the envelope of a part in all other cases, under `key` in the cache.
/// \pre reuse.reference
volmesh::Makers starting_envelopes(volmesh::Makers makers, const Reuse& reuse, const volmesh::PartEnvelopeMaker& ordinary,
                                   const std::function<ContentKey(const volmesh::PartEnvelopeTask&, const RunContext&)>& key);

/// Reports, for each part of a wall that took over triangles and whose envelope was not requested, why that envelope did not start from the reference's. To be
/// called after the wall's envelope was made.
void tell_other_envelopes(const std::vector<volmesh::PlacedPart>& parts, const Reuse& reuse, const RunContext& context);

/// Returns the key of a result that also depends on the reference; unchanged without a reference.
std::optional<ContentKey> beside_reference(const std::optional<ContentKey>& key, const Reuse& reuse, const RunContext& context);

/// cached() of stage_cache.h, for a result beside which data is stored or reported (ReferenceUse): a result from the cache restores the same data. `key` is
/// without the reference.
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
    found.reset();  // data of an entry that turned out to be damaged
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
