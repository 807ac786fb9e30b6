// Single description of every option set: a plain struct with defaults, and one Schema<T> with name, unit, range and help of each member. Lua tables, `--set
// stage.option=value`, help, manual and manifest are all generated from it. A member missing from the table causes a compile error.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

/// One member of an options struct.
template <class T>
struct Field {
  std::string_view name;
  std::variant<bool T::*, int T::*, double T::*, std::string T::*> member;
  Unit unit = Unit::none;
  double min = -k_unbounded;  ///< smallest valid value
  double max = k_unbounded;   ///< largest valid value
  std::string_view help;
  std::string_view automatic = {};  ///< for numbers: meaning of k_automatic or k_automatic_count, e.g. "50 body lengths"; empty = a number is required
  std::string_view choices = {};    ///< for strings: allowed values, separated by blanks; empty = any. For numbers: names of some values: "coarse=0.5 fine=2"
  bool required = false;            ///< the user must set the option
};

/// Specialise for every options struct T:
///   template <> struct Schema<T> {
///     static constexpr std::string_view stage = "envelope";
///     static constexpr std::array fields = {Field<T>{...}, ...};   // one for each member
///   };
template <class T>
struct Schema;

using OptionValue = std::variant<bool, std::int64_t, double, std::string>;
enum class OptionKind { boolean, integer, number, text };

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

  /// Returns true if the value is k_automatic, or is k_automatic_count for an integer option that allows it.
  bool is_automatic_value(const OptionValue& value) const;
  /// Returns "0.35", "automatic (50 body lengths)" or "required".
  std::string default_text() const;
  /// Returns "1 <= x", "0 .. 1 rad" or "one of a, b"; empty if any value is valid.
  std::string range_text() const;
};

using OptionTable = std::vector<Option>;

namespace detail {

/// Converts to any type that a schema can describe; used to count the members of an aggregate.
struct AnyMember {
  template <class U>
  operator U() const;  // never defined
};

template <class T, std::size_t... I>
constexpr bool is_brace_constructible(std::index_sequence<I...>) {
  return requires { T{((void)I, AnyMember{})...}; };
}

template <class T, std::size_t N = 0>
constexpr std::size_t member_count() {
  if constexpr (is_brace_constructible<T>(std::make_index_sequence<N + 1>{})) return member_count<T, N + 1>();
  else return N;
}

}  // namespace detail

/// Returns the options of `instance`, in schema order. `instance` must outlive the table.
template <class T>
OptionTable options_of(T& instance) {
  static_assert(detail::member_count<T>() == Schema<T>::fields.size(), "every member of the options struct needs one entry in its Schema");
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
    std::visit(
        [&](auto member) {
          using M = std::remove_reference_t<decltype(instance.*member)>;
          T* object = &instance;
          if constexpr (std::is_same_v<M, int>) {
            option.kind = OptionKind::integer;
            option.default_value = static_cast<std::int64_t>(defaults.*member);
            option.get = [object, member] { return OptionValue(static_cast<std::int64_t>(object->*member)); };
            option.store = [object, member](const OptionValue& v) { object->*member = static_cast<int>(std::get<std::int64_t>(v)); };
          } else {
            option.kind = std::is_same_v<M, bool> ? OptionKind::boolean : std::is_same_v<M, double> ? OptionKind::number : OptionKind::text;
            option.default_value = defaults.*member;
            option.get = [object, member] { return OptionValue(object->*member); };
            option.store = [object, member](const OptionValue& v) { object->*member = std::get<M>(v); };
          }
        },
        field.member);
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

/// Parses `text` according to the option's kind ("35*deg", "35deg", "2.5mm", "1e-6", "true", "automatic" ...) and sets the option.
/// \throws Error(bad_argument)
void set_option_from_text(const Option& option, std::string_view text);

/// \throws Error(bad_argument) naming every required option of the table that has no value (NaN)
void require_options(const OptionTable& table, std::string_view attempted);

/// Returns the candidate with the smallest edit distance if it is small enough for a likely misspelling; else an empty string.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Returns a JSON object {"envelope": {"layers": 30, ...}, ...} of all options of the table; NaN is written as "automatic".
std::string options_to_json(const OptionTable& table);

/// Returns several lines with name, default, unit, range and help of each option, for --help and help().
std::string options_help(const OptionTable& table);

}  // namespace sterna
