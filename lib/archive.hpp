// Saving and loading by one description: each structure lists its fields once (`exchange`), and the same list writes,
// reads and measures them. An array goes by name, element type and count; nothing here knows about files.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "error.hpp"

namespace ogive {

enum class ElementType : std::int32_t { Float64 = 1, Int32 = 2, Int64 = 3, Uint8 = 4 };

template <class T>
constexpr ElementType element_type() {
  if constexpr (std::is_same_v<T, double>) {
    return ElementType::Float64;
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return ElementType::Int32;
  } else if constexpr (std::is_same_v<T, std::int64_t>) {
    return ElementType::Int64;
  } else {
    static_assert(std::is_same_v<T, std::uint8_t> || std::is_same_v<T, char>);
    return ElementType::Uint8;
  }
}

// Grows by one with each set of arrays that is added. 2: loads, forces of the host, sums over pairs. 3: the energy watch, surfaces,
// total Lagrangian bodies. 4: dropped debris, the end of the energy exchange, groups at rest. 5: surfaces of total
// Lagrangian bodies.
constexpr std::int32_t save_version = 6;

class Archive {
 public:
  virtual ~Archive() = default;
  virtual bool loading() const = 0;
  // Of what is read; arrays that it has not keep their initial values.
  std::int32_t version() const { return version_; }
  void exchange_version() {
    value("version", version_);
    if (version_ < 1 || version_ > save_version)
      throw Error(ErrorKind::Format, "version: this library reads 1.." + std::to_string(save_version) + ", found " +
                                         std::to_string(version_));
  }

  // A single value; enumerations travel as int32, bool as int32 (0 or 1).
  template <class T>
  void value(const std::string& name, T& x) {
    if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      std::int32_t i = static_cast<std::int32_t>(x);
      fixed(name, &i, 1);
      x = static_cast<T>(i);
    } else {
      fixed(name, &x, 1);
    }
  }
  template <class T, std::size_t N>
  void value(const std::string& name, std::array<T, N>& x) {
    if constexpr (std::is_enum_v<T>) {
      std::array<std::int32_t, N> i;
      for (std::size_t k = 0; k < N; ++k) i[k] = static_cast<std::int32_t>(x[k]);
      fixed(name, i.data(), N);
      for (std::size_t k = 0; k < N; ++k) x[k] = static_cast<T>(i[k]);
    } else {
      fixed(name, x.data(), N);
    }
  }
  void value(const std::string& name, std::string& text) { resizable(name, text, 1 << 20); }
  // An array whose length is part of what is saved; a longer one than limit is refused before memory is taken.
  template <class Container>
  void resizable(const std::string& name, Container& x, std::int64_t limit) {
    using T = typename Container::value_type;
    if (loading()) {
      const std::int64_t n = find(name, element_type<T>());
      if (n < 0 || n > limit)
        throw Error(ErrorKind::Format,
                    name + ": expected at most " + std::to_string(limit) + " elements, found " + std::to_string(n));
      x.resize(static_cast<std::size_t>(n));
      get(name, n, x.data());
    } else {
      put(name, element_type<T>(), static_cast<std::int64_t>(x.size()), x.data());
    }
  }
  // An array whose length is known from what was read before.
  template <class Container>
  void sized(const std::string& name, Container& x, std::int64_t count) {
    using T = typename Container::value_type;
    if (loading()) {
      expect(name, element_type<T>(), count);
      x.resize(static_cast<std::size_t>(count));
      get(name, count, x.data());
    } else {
      put(name, element_type<T>(), static_cast<std::int64_t>(x.size()), x.data());
    }
  }

 protected:
  virtual void put(const std::string& name, ElementType type, std::int64_t count, const void* data) = 0;
  virtual std::int64_t find(const std::string& name, ElementType type) = 0;  // count; throws if absent or another type
  virtual void get(const std::string& name, std::int64_t count, void* data) = 0;

 private:
  std::int32_t version_ = save_version;
  void expect(const std::string& name, ElementType type, std::int64_t count) {
    const std::int64_t n = find(name, type);
    if (n != count)
      throw Error(ErrorKind::Format,
                  name + ": expected " + std::to_string(count) + " elements, found " + std::to_string(n));
  }
  template <class T>
  void fixed(const std::string& name, T* x, std::int64_t count) {
    if (loading()) {
      expect(name, element_type<T>(), count);
      get(name, count, x);
    } else {
      put(name, element_type<T>(), count, x);
    }
  }
};

}  // namespace ogive
