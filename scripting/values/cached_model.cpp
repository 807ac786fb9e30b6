#include "scripting/values/cached_model.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <set>

#include "geom/base/error.h"
#include "geom/cad/shape.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/lua/component_value.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/model_archive.h"
#include "scripting/values/models.h"
#include "scripting/values/script_key.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

constexpr std::size_t k_listed_names = 4;  ///< number of input names in the log

class MemorySink final : public ByteSink {
 public:
  void put(const void* bytes, std::size_t n) override { bytes_.append(static_cast<const char*>(bytes), n); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(const std::string& bytes) : bytes_(bytes) {}
  void take(void* bytes, std::size_t n) override {
    if (n > n_left()) refuse();
    if (n > 0) std::memcpy(bytes, bytes_.data() + at_, n);  // an empty vector has no memory to write to
    at_ += n;
  }
  std::uint64_t n_left() const override { return bytes_.size() - at_; }
  [[noreturn]] void refuse() const override {
    throw Error({.code = ErrorCode::internal, .attempted = "keeping a model", .problem = "the stored model cannot be read"});
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// \throws NotKept
void write_model_value(ByteSink& sink, const ModelValue& value) {
  ModelSink models(sink);
  write_value(models, value);
}

ModelValue read_model_value(ByteSource& source, const ModelSource::ShapeOf& shape_of) {
  ModelValue value;
  ModelSource models(source, shape_of);
  read_value(models, value);
  if (std::ranges::any_of(value.parts, [](const ModelPart& part) { return part.own == nullptr; })) source.refuse();
  return value;
}

/// Returns the bytes of a model that is unchanged after reading back. Empty if it would change; the log then reports the reason.
std::string bytes_of(const ModelValue& value, std::string_view verb, const RunContext& context) {
  const auto written = [](const ModelValue& v) {
    MemorySink sink;
    write_model_value(sink, v);
    return sink.bytes();
  };
  try {
    std::string bytes = written(value);
    MemorySource source(bytes);
    const auto some_shape = std::make_shared<const CadShape>(std::function<std::shared_ptr<const CadShape>()>());
    if (written(read_model_value(source, [&](std::size_t) { return some_shape; })) == bytes) return bytes;
    context.debug(std::string(verb) + ": the model is not cached, because reading it back would not give the same bits");
  } catch (const NotKept& what) {
    context.debug(std::string(verb) + ": the model is not cached, because it has " + what.kind);
  }
  return {};
}

/// Adds the data that a key by content omits, although they are part of the model's value or messages. Returns false for a function, because its results are
/// unknown before it is called.
bool add_names(const ScriptValue& value, KeyMaker& maker) {
  const auto add_inputs = [&](const std::vector<InputFile>& inputs) {
    for (const InputFile& file : inputs) maker.add(file.name);
  };
  if (const auto* text = std::get_if<std::string>(&value)) maker.add(*text);
  else if (const auto* model = std::get_if<ModelHandle>(&value)) add_inputs((*model)->inputs);
  else if (const auto* surface = std::get_if<SurfaceHandle>(&value)) add_inputs((*surface)->inputs);
  else if (const auto* table = std::get_if<TableHandle>(&value)) {
    for (const ScriptValue& item : (*table)->items)
      if (!add_names(item, maker)) return false;
    return std::all_of((*table)->fields.begin(), (*table)->fields.end(), [&](const auto& field) { return add_names(field.second, maker); });
  }
  return !std::holds_alternative<FunctionHandle>(value);
}

std::optional<ContentKey> key_of_model(const ScriptCall& call) {
  KeyMaker maker("model");
  if (!std::all_of(call.arguments.begin(), call.arguments.end(), [&](const ScriptValue& argument) { return add_names(argument, maker); })) return std::nullopt;
  const std::optional<ContentKey> key = key_of_call(call);
  return key ? std::optional(maker.add(*key).key()) : std::nullopt;
}

/// Copies components, because they change in place: a later call needs their current state.
ScriptValue frozen(const ScriptValue& value) {
  if (const auto* component = std::get_if<ComponentHandle>(&value)) return std::make_shared<ComponentValue>(**component);
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table) return value;
  auto copy = std::make_shared<ScriptTable>(**table);
  for (ScriptValue& item : copy->items) item = frozen(item);
  for (auto& [name, field] : copy->fields) field = frozen(field);
  return TableHandle(std::move(copy));
}

/// The verb's model, which is computed only when data are needed that are not stored.
class MadeLater {
 public:
  MadeLater(const ScriptVerb& verb, const ScriptCall& call, const ContentKey& bytes_key) : verb_(verb), call_(call), bytes_key_(bytes_key) {
    for (ScriptValue& argument : call_.arguments) argument = frozen(argument);
  }
  /// Returns the shape of the n-th model that was written: the whole model first, then the different models of parts.
  std::shared_ptr<const CadShape> shape(std::size_t n) {
    std::call_once(is_made_, [&] { made_ = make(); });
    if (n == 0) return made_->model.shape;
    std::set<const Model*> seen;
    for (const ModelPart& part : made_->parts)
      if (seen.insert(part.own.get()).second && seen.size() == n) return part.own->shape;
    return nullptr;
  }

 private:
  ModelHandle make() const {
    const RunContext& context = call_.session.context;
    context.info(std::string(call_.verb) + ": runs again, because OpenCASCADE's shape of the model is required, which the cache does not store");
    const ScriptValue value = verb_.run(call_);
    ModelHandle model = std::get<ModelHandle>(value);
    if (KeyMaker("bytes").add(bytes_of(*model, call_.verb, context)).key() != bytes_key_)
      throw Error({.code = ErrorCode::geometry_failed,
                   .attempted = call_.attempted(),
                   .problem = "the verb gives another model than before in this run",
                   .hint = "an input file changed during the run: run the script again"});
    return model;
  }
  const ScriptVerb& verb_;
  ScriptCall call_;
  ContentKey bytes_key_;
  std::once_flag is_made_;
  ModelHandle made_;
};

/// Returns "of a.step, b.step".
std::string inputs_text(const ModelValue& value) {
  std::string text;
  for (std::size_t i = 0; i < std::min(k_listed_names, value.inputs.size()); ++i) text += (i == 0 ? "of " : ", ") + value.inputs[i].name;
  return value.inputs.size() > k_listed_names ? text + " and " + std::to_string(value.inputs.size() - k_listed_names) + " more" : text;
}

}  // namespace

ScriptValue cached_model(const ScriptVerb& verb, const ScriptCall& call) {
  const StageCache* cache = verb.is_kept ? call.session.cache : nullptr;
  if (!cache) return verb.run(call);
  const std::optional<ContentKey> key = key_of_model(call);
  if (!key) {
    call.session.context.debug(std::string(verb.name) + ": cannot be cached, because the origin of some input is unknown");
    return verb.run(call);
  }
  const RunContext& context = call.session.context;
  ModelHandle found;
  const auto read = [&](ByteSource& source) {
    std::string bytes;
    read_value(source, bytes);
    const auto later = std::make_shared<MadeLater>(verb, call, KeyMaker("bytes").add(bytes).key());
    const auto shape_of = [&](std::size_t n) { return std::make_shared<const CadShape>([later, n] { return later->shape(n); }); };
    MemorySource memory(bytes);
    found = std::make_shared<const ModelValue>(read_model_value(memory, shape_of));
  };
  if (cache->find(verb.name, *key, read, context)) {
    report_reuse(call.session.reuse(), verb.name, inputs_text(*found), context);
    return found;
  }
  ScriptValue value = verb.run(call);
  if (const auto* model = std::get_if<ModelHandle>(&value)) {
    const std::string bytes = bytes_of(**model, verb.name, context);
    if (!bytes.empty())
      cache->store(
          verb.name, *key, [&](ByteSink& sink) { write_value(sink, bytes); }, context);
  }
  return value;
}

}  // namespace sterna::scripting
