#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace app {

enum class NumberType { Byte, Int32, Uint32, Int64, Uint64, Float64 };

/// The type of numbers in memory as they are named in a file.
template <class T>
constexpr NumberType numberType()
{
    if constexpr (std::is_same_v<T, double>) return NumberType::Float64;
    else if constexpr (sizeof(T) == 1) return NumberType::Byte;
    else if constexpr (sizeof(T) == 4) return std::is_signed_v<T> ? NumberType::Int32 : NumberType::Uint32;
    else return std::is_signed_v<T> ? NumberType::Int64 : NumberType::Uint64;
}

/// Version of the library that is loaded: "1.10.8".
std::string hdf5Version();

/// Makes an HDF5 file in memory: tables of numbers, each with its unit as an attribute, and texts. Names are paths;
/// groups on their way are made. Nothing is written to disk here: the library does not survive a full one.
class Hdf5Writer {
 public:
    Hdf5Writer();
    ~Hdf5Writer();
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    /// `rows` rows of `columns` numbers, one behind the other in memory.
    void table(const std::string& name, std::string_view unit, NumberType type, std::size_t rows, std::size_t columns, const void* numbers);
    /// `rows` rows of `columns` numbers, of which row r begins at row(r).
    void table(const std::string& name, std::string_view unit, NumberType type, std::size_t rows, std::size_t columns,
               const std::function<const void*(std::size_t)>& row);
    void text(const std::string& name, const std::string& content);

    /// The file's bytes; nothing can be added afterwards.
    std::string finish();

 private:
    struct File;
    std::unique_ptr<File> file_;
};

/// Reads what Hdf5Writer has made. Throws std::runtime_error naming what is not there, or is another size than wanted.
class Hdf5Reader {
 public:
    explicit Hdf5Reader(std::string_view image);
    ~Hdf5Reader();
    Hdf5Reader(const Hdf5Reader&) = delete;
    Hdf5Reader& operator=(const Hdf5Reader&) = delete;

    bool has(const std::string& name) const;
    /// Rows and columns.
    std::array<std::size_t, 2> size(const std::string& name) const;
    /// Sizes and types must be those of the file.
    void table(const std::string& name, NumberType type, std::size_t rows, std::size_t columns, void* numbers) const;
    void table(const std::string& name, NumberType type, std::size_t rows, std::size_t columns, const std::function<void*(std::size_t)>& row) const;
    std::string text(const std::string& name) const;

 private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace app
