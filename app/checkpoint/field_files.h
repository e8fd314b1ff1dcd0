#pragma once

#include "app/checkpoint/hdf5_image.h"
#include "sim/renamed.h"

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// Visitors of fields (sim/state_fields.h) that write them into an HDF5 file and read them from one.

namespace app {

/// How many numbers an element of a list is: a number, or a fixed vector of Eigen's.
template <class T>
struct ElementOfList {
    using Number = T;
    static constexpr std::size_t kSize = 1;
};
template <class T>
requires requires { T::SizeAtCompileTime; }
struct ElementOfList<T> {
    using Number = typename T::Scalar;
    static constexpr std::size_t kSize = T::SizeAtCompileTime;
};

class FieldWriter {
 public:
    static constexpr bool kFills = false;
    explicit FieldWriter(Hdf5Writer& file) : file_(file) {}

    template <class T>
    void number(const std::string& name, std::string_view unit, const T& x)
    {
        file_.table(name, unit, numberType<T>(), 1, 1, &x);
    }
    template <class T>
    void list(const std::string& name, std::string_view unit, const std::vector<T>& v)
    {
        using Element = ElementOfList<T>;
        file_.table(name, unit, numberType<typename Element::Number>(), v.size(), Element::kSize, v.data());
    }
    template <class Row>
    void rows(const std::string& name, std::string_view unit, std::size_t count, std::size_t size, Row&& row)
    {
        using Number = std::remove_cvref_t<decltype(*row(0))>;
        file_.table(name, unit, numberType<Number>(), count, size, std::function<const void*(std::size_t)>(row));
    }

 private:
    Hdf5Writer& file_;
};

/// Takes fields by the names that they had before, too (sim/renamed.h).
/// Throws std::runtime_error where a field is missing or has another size or type.
class FieldReader {
 public:
    static constexpr bool kFills = true;
    explicit FieldReader(const Hdf5Reader& file) : file_(file) {}

    template <class T>
    void number(const std::string& name, std::string_view, T& x)
    {
        file_.table(nameIn(name), numberType<T>(), 1, 1, &x);
    }
    template <class T>
    void list(const std::string& name, std::string_view, std::vector<T>& v)
    {
        using Element = ElementOfList<T>;
        v.resize(file_.size(nameIn(name))[0]);
        file_.table(nameIn(name), numberType<typename Element::Number>(), v.size(), Element::kSize, v.data());
    }
    template <class Row>
    void rows(const std::string& name, std::string_view, std::size_t count, std::size_t size, Row&& row)
    {
        using Number = std::remove_cvref_t<decltype(*row(0))>;
        file_.table(nameIn(name), numberType<Number>(), count, size, std::function<void*(std::size_t)>(row));
    }

 private:
    std::string nameIn(const std::string& name) const { return file_.has(name) ? name : sim::formerName(name); }

    const Hdf5Reader& file_;
};

}  // namespace app
