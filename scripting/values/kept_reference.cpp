#include "scripting/values/kept_reference.h"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>
#include <utility>

#include "geom/base/error.h"
#include "scripting/cache/sealed_file.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

/// Returns the key of the file. Only this version can read it, because cases of another version are run again anyway.
ContentKey file_key() { return KeyMaker("kept by the reference case of a series").add(STERNA_VERSION).key(); }

template <class T>
std::vector<T> tail(const std::vector<T>& all, std::size_t from) {
  return {all.begin() + static_cast<std::ptrdiff_t>(std::min(from, all.size())), all.end()};
}

}  // namespace

ContentKey triangles_key(const TriMesh& mesh) { return KeyMaker("vertices of triangles").add(mesh.triangles).key(); }

ContentKey connectivity_of(const TriMesh& mesh) { return KeyMaker("connectivity").add(mesh.triangles).add(mesh.triangle_patch).add(mesh.patches).key(); }

ContentKey ReferenceUse::key(const RunContext& context) {
  if (is_this_) return KeyMaker("the reference of a series itself").key();
  read(context);
  return *seal_;
}

const std::vector<KeptPart>& ReferenceUse::parts(const RunContext& context) {
  read(context);
  return parts_;
}

const std::vector<KeptEnvelope>& ReferenceUse::envelopes(const RunContext& context) {
  read(context);
  return envelopes_;
}

void ReferenceUse::read(const RunContext& context) {
  if (is_this_ || seal_) return;
  const std::string attempted = "starting from the reference case " + name_;
  const auto refuse = [&](const std::string& problem) {
    throw Error({.code = ErrorCode::file_malformed,
                 .attempted = attempted,
                 .problem = file_.string() + " is damaged: " + problem,
                 .hint = "remove the file and run the series again, which repeats the reference case"});
  };
  SealedFile file(file_);
  if (!file.is_open())
    throw Error({.code = ErrorCode::file_not_found,
                 .attempted = attempted,
                 .problem = file_.string() + ": " + std::generic_category().message(errno),
                 .hint = "remove the file and run the series again, which repeats the reference case"});
  if (const std::string problem = file.problem(file_key(), context); !problem.empty()) refuse(problem);
  try {
    const std::unique_ptr<ByteSource> source = file.content();
    read_value(*source, parts_);
    read_value(*source, envelopes_);
    if (source->n_left() > 0) source->refuse();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::file_malformed) throw;
    refuse(error.info().problem);
  }
  seal_ = file.seal();
}

void ReferenceUse::save(const RunContext& context) const {
  context.info("stored for the other cases: surfaces of " + std::to_string(parts_.size()) + " parts and " + std::to_string(envelopes_.size()) +
               " envelopes, in " + file_.filename().string());
  write_sealed(
      file_, file_key(),
      [&](ByteSink& sink) {
        write_value(sink, parts_);
        write_value(sink, envelopes_);
      },
      context);
}

void ReferenceUse::keep(KeptPart part) {
  part.call = surface();
  parts_.push_back(std::move(part));
}

void ReferenceUse::keep(KeptEnvelope envelope) {
  const auto key = [](const KeptEnvelope& e) {
    volmesh::EnvelopeOptions named = e.options;
    return KeyMaker("kept envelope").add(e.wall).add(sterna::options_of(named)).add(e.start.points).key();
  };
  const ContentKey own = key(envelope);
  if (std::any_of(envelopes_.begin(), envelopes_.end(), [&](const KeptEnvelope& other) { return other.wall == envelope.wall && key(other) == own; })) return;
  envelopes_.push_back(std::move(envelope));
}

void ReferenceUse::note_carried(const TriMesh& mesh, const std::string& name) { carried_.push_back({triangles_key(mesh), name, false}); }

CarriedPart* ReferenceUse::carried(const ContentKey& triangles) {
  for (const bool is_reported : {false, true})  // parts without a reported envelope first, so that each of several mirror images with the same triangles is
                                                // returned once
    for (CarriedPart& part : carried_)
      if (part.triangles == triangles && part.has_envelope == is_reported) return &part;
  return nullptr;
}

void ReferenceUse::report(const std::string& line, const Reuse& reuse, const RunContext& context) {
  context.info(line);
  lines_.push_back(line);
  if (reuse.lines != nullptr) reuse.lines->push_back(line);
}

ReferenceUse::Beside ReferenceUse::since(const Mark& mark) const {
  if (is_this_) return {tail(parts_, mark.n_parts), tail(envelopes_, mark.n_envelopes), {}, {}};
  return {{}, {}, tail(carried_, mark.n_carried), tail(lines_, mark.n_lines)};
}

void ReferenceUse::take(Beside beside, const Reuse& reuse, const RunContext& context) {
  for (KeptPart& part : beside.parts) keep(std::move(part));
  for (KeptEnvelope& envelope : beside.envelopes) keep(std::move(envelope));
  std::move(beside.carried.begin(), beside.carried.end(), std::back_inserter(carried_));
  for (const std::string& line : beside.lines) report(line, reuse, context);
}

}  // namespace sterna::scripting
