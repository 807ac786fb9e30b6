// Single description of every option set and request: a plain struct with defaults, and one Schema<T> with name, unit, range and help of each member. Lua
// tables, `--set stage.option=value`, strings of the command line, help, manual, manifest and stored values are all generated from it. A member missing from
// the table causes a compile error.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geom/base/member_count.h"
#include "geom/base/vec3.h"

namespace sterna {

/// Automatic: value of a double option whose default follows from the geometry or from other options.
inline constexpr double k_automatic = std::numeric_limits<double>::quiet_NaN();
constexpr bool is_automatic(double value) { return value != value; }
/// Automatic value of an integer option (a count) that has a text in `automatic`: "automatic" in scripts and on the command line.
inline constexpr int k_automatic_count = -1;
constexpr bool is_automatic(int value) { return value == k_automatic_count; }

enum class Unit { none, metre, radian, second, byte };
/// "m", "rad", "s", "B" or "".
std::string_view to_string(Unit unit);

inline constexpr double k_unbounded = std::numeric_limits<double>::infinity();

/// Point or vector without a value: the default of a required one.
inline constexpr Vec3 k_no_vector{k_automatic, k_automatic, k_automatic};

/// Access to a member of an enumeration type by the index of its enumerator.
template <class T>
struct EnumMember {
  int (*get)(const T&);
  void (*set)(T&, int);
};

/// Describes the member `Pointer`, whose enumerators are numbered from 0 on in the order of the field's `choices`.
template <class T, auto Pointer>
constexpr EnumMember<T> enum_member() {
  using E = std::remove_reference_t<decltype(std::declval<T&>().*Pointer)>;
  static_assert(std::is_enum_v<E>);
  return {[](const T& object) { return static_cast<int>(object.*Pointer); }, [](T& object, int index) { object.*Pointer = static_cast<E>(index); }};
}

/// The value of an option. An enumeration is the name of its enumerator; std::monostate is an optional vector without a value.
using OptionValue = std::variant<bool, std::int64_t, double, std::string, Vec3, std::vector<double>, std::vector<Vec3>, std::monostate>;
enum class OptionKind { boolean, integer, number, string, vector, numbers, vectors };

/// Access to an option that is no plain member: a list that users write as a string, or a member of a struct inside T.
template <class T>
struct OptionAccess {
  OptionKind kind;
  OptionValue (*get)(const T&);
  void (*set)(T&, const OptionValue&);
  std::size_t n_inner = 0;  ///< number of members of the struct inside T; 0: the option is a member of T
};

namespace detail {

template <class T, class M>
T class_of(M T::*);
template <class T, class M>
M type_of(M T::*);

template <class M>
constexpr OptionKind kind_of_member() {
  if constexpr (std::is_same_v<M, bool>) return OptionKind::boolean;
  else if constexpr (std::is_same_v<M, int>) return OptionKind::integer;
  else if constexpr (std::is_same_v<M, double>) return OptionKind::number;
  else if constexpr (std::is_same_v<M, std::string>) return OptionKind::string;
  else if constexpr (std::is_same_v<M, std::vector<double>>) return OptionKind::numbers;
  else if constexpr (std::is_same_v<M, std::vector<Vec3>>) return OptionKind::vectors;
  else return OptionKind::vector;
}

template <class M>
OptionValue option_value_of(const M& value) {
  if constexpr (std::is_same_v<M, int>) return static_cast<std::int64_t>(value);
  else if constexpr (std::is_same_v<M, std::optional<Vec3>>) return value ? OptionValue(*value) : OptionValue(std::monostate{});
  else return value;
}

template <class M>
void store_value(M& member, const OptionValue& value) {
  const std::int64_t* whole = std::get_if<std::int64_t>(&value);
  if constexpr (std::is_same_v<M, int>) member = static_cast<int>(std::get<std::int64_t>(value));
  else if constexpr (std::is_same_v<M, double>) member = whole ? static_cast<double>(*whole) : std::get<double>(value);
  else if constexpr (std::is_same_v<M, std::optional<Vec3>>) member = std::holds_alternative<Vec3>(value) ? std::optional(std::get<Vec3>(value)) : std::nullopt;
  else member = std::get<M>(value);
}

}  // namespace detail

/// Describes the member `Pointer`, which users give as a string. Parse returns its value, or throws Error(bad_argument); Print returns the string.
template <auto Pointer, auto Parse, auto Print>
constexpr auto text_option() {
  using T = decltype(detail::class_of(Pointer));
  return OptionAccess<T>{OptionKind::string, [](const T& object) { return OptionValue(Print(object.*Pointer)); },
                         [](T& object, const OptionValue& text) { object.*Pointer = Parse(std::get<std::string>(text)); }};
}

/// Describes the member `Inner` of the struct that is the member `Outer`. T may have one such struct.
template <auto Outer, auto Inner>
constexpr auto inner_option() {
  using T = decltype(detail::class_of(Outer));
  using M = decltype(detail::type_of(Inner));
  return OptionAccess<T>{detail::kind_of_member<M>(), [](const T& object) { return detail::option_value_of((object.*Outer).*Inner); },
                         [](T& object, const OptionValue& value) { detail::store_value((object.*Outer).*Inner, value); },
                         member_count<decltype(detail::type_of(Outer))>()};
}

/// One member of an options struct.
template <class T>
struct Field {
  std::string_view name;
  std::variant<bool T::*, int T::*, double T::*, std::string T::*, Vec3 T::*, std::optional<Vec3> T::*, std::vector<double> T::*, std::vector<Vec3> T::*,
               EnumMember<T>, OptionAccess<T>>
      member;
  Unit unit = Unit::none;
  double min = -k_unbounded;  ///< smallest valid value
  double max = k_unbounded;   ///< largest valid value
  std::string_view help;
  std::string_view automatic = {};  ///< for numbers: meaning of k_automatic or k_automatic_count, e.g. "50 body lengths"; empty = a number is required
  std::string_view choices = {};    ///< for strings and enumerations: allowed values, separated by blanks; empty = any. For numbers: names of some values:
                                    ///< "coarse=0.5 fine=2"
  bool required = false;            ///< the user must set the option
};

/// Specialise for every options struct T:
///   template <> struct Schema<T> {
///     static constexpr std::string_view stage = "envelope";
///     static constexpr std::array fields = {Field<T>{...}, ...};   // one for each member
///   };
template <class T>
struct Schema;

/// Returns "a whole number", "{x, y, z}" and so on, for messages.
std::string_view kind_text(OptionKind kind);

/// Type-erased view of one option of an existing options struct (which must outlive the view).
struct Option {
  std::string_view stage;
  std::string_view name;
  OptionKind kind = OptionKind::number;
  Unit unit = Unit::none;
  double min = -k_unbounded;
  double max = k_unbounded;
  std::string_view help;
  std::string_view automatic;
  std::string_view choices;
  bool required = false;
  OptionValue default_value;
  std::function<OptionValue()> get;
  std::function<void(const OptionValue&)> store;  ///< stores without any check; use set_option

  /// Returns true if the value is k_automatic, is k_automatic_count for an integer option that allows it, or is an optional vector without a value.
  bool is_automatic_value(const OptionValue& value) const;
  /// Returns false if the option has no valid value: an automatic or empty one, k_no_vector, or a number out of its range. A required option needs one.
  bool has_value() const;
  /// Returns "0.35", "automatic (50 body lengths)" or "required".
  std::string default_text() const;
  /// Returns "1 <= x", "0 .. 1 rad" or "one of a, b"; empty if any value is valid.
  std::string range_text() const;
};

using OptionTable = std::vector<Option>;

namespace detail {

/// Returns the name with an index in a list of names separated by blanks; empty if there is none.
std::string_view choice_at(std::string_view choices, int index);
/// Returns the index of a name in such a list; -1 if it is not there.
int index_of_choice(std::string_view choices, std::string_view name);

}  // namespace detail

/// Returns the kind of the option that a field describes.
template <class T>
OptionKind kind_of_field(const Field<T>& field) {
  return std::visit(
      []<class Member>(const Member& member) {
        if constexpr (std::is_same_v<Member, EnumMember<T>>) return OptionKind::string;
        else if constexpr (std::is_same_v<Member, OptionAccess<T>>) return member.kind;
        else return detail::kind_of_member<std::remove_reference_t<decltype(std::declval<T&>().*member)>>();
      },
      field.member);
}

/// Returns the value of the member that a field describes.
template <class T>
OptionValue value_of_member(const T& object, const Field<T>& field) {
  return std::visit(
      [&]<class Member>(const Member& member) -> OptionValue {
        if constexpr (std::is_same_v<Member, EnumMember<T>>) return std::string(detail::choice_at(field.choices, member.get(object)));
        else if constexpr (std::is_same_v<Member, OptionAccess<T>>) return member.get(object);
        else return detail::option_value_of(object.*member);
      },
      field.member);
}

/// Stores a value in the member that a field describes, without any check. Whole numbers are accepted for floating-point members.
template <class T>
void store_member(T& object, const Field<T>& field, const OptionValue& value) {
  std::visit(
      [&]<class Member>(const Member& member) {
        if constexpr (std::is_same_v<Member, EnumMember<T>>) member.set(object, detail::index_of_choice(field.choices, std::get<std::string>(value)));
        else if constexpr (std::is_same_v<Member, OptionAccess<T>>) member.set(object, value);
        else detail::store_value(object.*member, value);
      },
      field.member);
}

namespace detail {

/// Returns the number of members that the Schema describes. The fields of a struct inside T count as one member if they describe all of its members.
template <class T>
constexpr std::size_t n_described() {
  std::size_t n = 0, n_inner = 0, n_expected = 0;
  for (const Field<T>& field : Schema<T>::fields) {
    const auto* access = std::get_if<OptionAccess<T>>(&field.member);
    if (!access || access->n_inner == 0) ++n;
    else ++n_inner, n_expected = access->n_inner;
  }
  return n_inner == n_expected ? n + (n_inner > 0 ? 1 : 0) : 0;
}

}  // namespace detail

/// Returns the options of `instance`, in schema order. `instance` must outlive the table.
template <class T>
OptionTable options_of(T& instance) {
  static_assert(member_count<T>() == detail::n_described<T>(), "every member of the options struct needs one entry in its Schema");
  static const T defaults{};
  OptionTable table;
  for (const Field<T>& field : Schema<T>::fields) {
    Option option;
    option.stage = Schema<T>::stage;
    option.name = field.name;
    option.unit = field.unit;
    option.min = field.min;
    option.max = field.max;
    option.help = field.help;
    option.automatic = field.automatic;
    option.choices = field.choices;
    option.required = field.required;
    option.kind = kind_of_field(field);
    option.default_value = value_of_member(defaults, field);
    option.get = [object = &instance, described = &field] { return value_of_member(*object, *described); };
    option.store = [object = &instance, described = &field](const OptionValue& value) { store_member(*object, *described, value); };
    table.push_back(std::move(option));
  }
  return table;
}
/// Sets one option after checking type, range and choices. Integers are accepted for floating-point options.
/// \throws Error(bad_argument) with name, value, unit and range.
void set_option(const Option& option, const OptionValue& value);

/// Finds an option by "name" or "stage.name".
/// \throws Error(unknown_option) with the nearest name as a suggestion; \p attempted starts the message.
const Option& find_option(const OptionTable& table, std::string_view name, std::string_view attempted);

/// Parses `text` according to the option's kind ("35*deg", "35deg", "2.5mm", "1e-6", "true", "automatic", "0,0,1.5m" ...) and sets the option.
/// \throws Error(bad_argument)
void set_option_from_text(const Option& option, std::string_view text);

/// \throws Error(bad_argument) naming every required option of the table that has no value (Option::has_value)
void require_options(const OptionTable& table, std::string_view attempted);

/// Returns the candidate with the smallest edit distance if it is small enough for a likely misspelling; else an empty string.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Returns a JSON object {"envelope": {"layers": 30, ...}, ...} of all options of the table; NaN is written as "automatic".
std::string options_to_json(const OptionTable& table);

/// Returns a JSON object {"name": "prop", "center": [0, 0, 0], ...} of one value, without members that have no value
/// (Option::has_value) and empty lists.
std::string value_to_json(const OptionTable& table);
/// Sets the options of a table from such an object. Members that the object does not have keep their value.
/// \throws Error(bad_argument) for an unknown member or a value that is not allowed; \p attempted starts the message
void set_value_from_json(const OptionTable& table, std::string_view json, std::string_view attempted);
/// Returns the elements of a JSON list as JSON. \throws Error(bad_argument) if the text is no list
std::vector<std::string> elements_of_json(std::string_view json, std::string_view attempted);
/// Returns a JSON list of JSON values.
std::string list_to_json(std::span<const std::string> elements);

/// Returns a JSON list of values with a Schema, for manifests and stored values.
template <class T>
std::string values_to_json(std::vector<T> values) {
  std::vector<std::string> elements;
  for (T& value : values) elements.push_back(value_to_json(options_of(value)));
  return list_to_json(elements);
}
/// Reads a list that values_to_json wrote. \throws Error(bad_argument)
template <class T>
std::vector<T> values_of_json(std::string_view json) {
  const std::string attempted = "reading " + std::string(Schema<T>::stage) + " from JSON";
  std::vector<T> values;
  for (const std::string& element : elements_of_json(json, attempted)) set_value_from_json(options_of(values.emplace_back()), element, attempted);
  return values;
}

/// Returns several lines with name, default, unit, range and help of each option, for --help and help().
std::string options_help(const OptionTable& table);

}  // namespace sterna
