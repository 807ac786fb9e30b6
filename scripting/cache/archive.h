// Serialisation of values to bytes. The same description serves hashing (keys) and storage (entries of the cache). It is exact to the bit: the value read back
// equals the value written.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/measured.h"
#include "geom/base/vec3.h"
#include "scripting/cache/members.h"

namespace sterna::scripting {

/// Destination of bytes.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void put(const void* bytes, std::size_t n) = 0;
};

/// Source of bytes.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// \throws Error(file_malformed) if fewer bytes are left
  virtual void take(void* bytes, std::size_t n) = 0;
  virtual std::uint64_t n_left() const = 0;
  /// \throws Error(file_malformed) always
  [[noreturn]] virtual void refuse() const = 0;
};

template <class T>
struct IsId : std::false_type {};
template <class Tag>
struct IsId<Id<Tag>> : std::true_type {};

/// True for types whose bytes in memory are their complete value: no padding, no pointers.
template <class T>
struct IsPlain : std::bool_constant<((std::is_arithmetic_v<T> || std::is_enum_v<T>)&&!std::is_same_v<T, bool>) || IsId<T>::value || std::is_same_v<T, Vec3>> {};
template <class T, std::size_t N>
struct IsPlain<std::array<T, N>> : IsPlain<T> {};

static_assert(std::endian::native == std::endian::little, "entries of the cache are little endian");
static_assert(sizeof(Vec3) == 3 * sizeof(double));

template <class T>
void write_value(ByteSink& sink, const T& value);
template <class T>
void read_value(ByteSource& source, T& value);

namespace detail {

inline void write_count(ByteSink& sink, std::size_t n) {
  const std::uint64_t count = n;
  sink.put(&count, sizeof count);
}
/// \param least minimum bytes of each element: an impossible count is refused before memory is allocated
inline std::size_t read_count(ByteSource& source, std::size_t least) {
  std::uint64_t count = 0;
  source.take(&count, sizeof count);
  if (count > source.n_left() / least) source.refuse();
  return static_cast<std::size_t>(count);
}

template <class T>
struct Archive {
  static void write(ByteSink& sink, const T& value) {
    if constexpr (IsPlain<T>::value) {
      sink.put(&value, sizeof value);
    } else {
      static_assert(k_members<T> > 0, "only plain structs are stored member by member");
      with_members<k_members<T>>(value, [&](const auto&... members) { (write_value(sink, members), ...); });
    }
  }
  static void read(ByteSource& source, T& value) {
    if constexpr (IsPlain<T>::value) source.take(&value, sizeof value);
    else with_members<k_members<T>>(value, [&](auto&... members) { (read_value(source, members), ...); });
  }
};

template <>
struct Archive<bool> {
  static void write(ByteSink& sink, const bool& value) { write_value(sink, static_cast<std::uint8_t>(value ? 1 : 0)); }
  static void read(ByteSource& source, bool& value) {
    std::uint8_t byte = 0;
    read_value(source, byte);
    if (byte > 1) source.refuse();
    value = byte == 1;
  }
};

template <>
struct Archive<std::string> {
  static void write(ByteSink& sink, const std::string& value) {
    write_count(sink, value.size());
    sink.put(value.data(), value.size());
  }
  static void read(ByteSource& source, std::string& value) {
    value.resize(read_count(source, 1));
    source.take(value.data(), value.size());
  }
};

template <class T>
struct Archive<std::vector<T>> {
  static void write(ByteSink& sink, const std::vector<T>& value) {
    write_count(sink, value.size());
    if constexpr (IsPlain<T>::value) sink.put(value.data(), value.size() * sizeof(T));
    else
      for (const T& item : value) write_value(sink, item);
  }
  static void read(ByteSource& source, std::vector<T>& value) {
    value.clear();
    value.resize(read_count(source, IsPlain<T>::value ? sizeof(T) : 1));
    if constexpr (IsPlain<T>::value) source.take(value.data(), value.size() * sizeof(T));
    else
      for (T& item : value) read_value(source, item);
  }
};

template <class I, class T>
struct Archive<Column<I, T>> {
  static void write(ByteSink& sink, const Column<I, T>& value) { write_value(sink, value.raw()); }
  static void read(ByteSource& source, Column<I, T>& value) { read_value(source, value.raw()); }
};

template <class T, std::size_t N>
struct Archive<std::array<T, N>> {
  static void write(ByteSink& sink, const std::array<T, N>& value) {
    for (const T& item : value) write_value(sink, item);
  }
  static void read(ByteSource& source, std::array<T, N>& value) {
    for (T& item : value) read_value(source, item);
  }
};

template <class A, class B>
struct Archive<std::pair<A, B>> {
  static void write(ByteSink& sink, const std::pair<A, B>& value) {
    write_value(sink, value.first);
    write_value(sink, value.second);
  }
  static void read(ByteSource& source, std::pair<A, B>& value) {
    read_value(source, value.first);
    read_value(source, value.second);
  }
};

template <class T>
struct Archive<std::optional<T>> {
  static void write(ByteSink& sink, const std::optional<T>& value) {
    write_value(sink, value.has_value());
    if (value) write_value(sink, *value);
  }
  static void read(ByteSource& source, std::optional<T>& value) {
    bool has_value = false;
    read_value(source, has_value);
    value.reset();
    if (has_value) read_value(source, value.emplace());
  }
};

template <class T>
struct Archive<std::shared_ptr<const T>> {
  static void write(ByteSink& sink, const std::shared_ptr<const T>& value) {
    write_value(sink, value != nullptr);
    if (value) write_value(sink, *value);
  }
  static void read(ByteSource& source, std::shared_ptr<const T>& value) {
    bool has_value = false;
    read_value(source, has_value);
    value.reset();
    if (!has_value) return;
    auto made = std::make_shared<T>();
    read_value(source, *made);
    value = std::move(made);
  }
};

template <>
struct Archive<Measured> {
  static void write(ByteSink&, const Measured&) {}
  static void read(ByteSource&, Measured&) {}
};

template <class Key, class T, class Less>
struct Archive<std::map<Key, T, Less>> {
  static void write(ByteSink& sink, const std::map<Key, T, Less>& value) {
    write_count(sink, value.size());
    for (const auto& [key, item] : value) {
      write_value(sink, key);
      write_value(sink, item);
    }
  }
  static void read(ByteSource& source, std::map<Key, T, Less>& value) {
    value.clear();
    for (std::size_t n = read_count(source, 1); n > 0; --n) {
      Key key{};
      read_value(source, key);
      read_value(source, value[std::move(key)]);
    }
  }
};

template <>
struct Archive<std::monostate> {
  static void write(ByteSink&, const std::monostate&) {}
  static void read(ByteSource&, std::monostate&) {}
};

template <class... T>
struct Archive<std::variant<T...>> {
  static void write(ByteSink& sink, const std::variant<T...>& value) {
    write_count(sink, value.index());
    std::visit([&](const auto& held) { write_value(sink, held); }, value);
  }
  static void read(ByteSource& source, std::variant<T...>& value) {
    std::uint64_t index = 0;
    source.take(&index, sizeof index);
    const auto read_held = [&]<std::size_t... I>(std::index_sequence<I...>) {
      return ((index == I && (read_value(source, value.template emplace<I>()), true)) || ...);
    };
    if (!read_held(std::index_sequence_for<T...>())) source.refuse();
  }
};

}  // namespace detail

template <class T>
void write_value(ByteSink& sink, const T& value) {
  detail::Archive<T>::write(sink, value);
}
template <class T>
void read_value(ByteSource& source, T& value) {
  detail::Archive<T>::read(source, value);
}

}  // namespace sterna::scripting
