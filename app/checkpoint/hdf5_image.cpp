#include "app/checkpoint/hdf5_image.h"

#include <H5Cpp.h>
#include <fmt/format.h>

#include <stdexcept>

namespace app {

namespace {

constexpr std::size_t kGrowth = std::size_t{1} << 22;  ///< growth of a file in memory [bytes]

const H5::PredType& typeOf(NumberType type)
{
    switch (type) {
        case NumberType::Byte: return H5::PredType::NATIVE_UINT8;
        case NumberType::Int32: return H5::PredType::NATIVE_INT32;
        case NumberType::Uint32: return H5::PredType::NATIVE_UINT32;
        case NumberType::Int64: return H5::PredType::NATIVE_INT64;
        case NumberType::Uint64: return H5::PredType::NATIVE_UINT64;
        case NumberType::Float64: break;
    }
    return H5::PredType::NATIVE_DOUBLE;
}

/// What the library has to say, as an exception that everybody knows.
template <class F>
auto withReason(const std::string& what, F&& f)
try {
    return f();
} catch (const H5::Exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", what, error.getDetailMsg()));
}

H5::FileAccPropList inMemory(std::string_view image = {})
{
    H5::Exception::dontPrint();
    H5::FileAccPropList access;
    access.setCore(kGrowth, false);
    if (!image.empty()) H5Pset_file_image(access.getId(), const_cast<char*>(image.data()), image.size());
    return access;
}

H5::DataSpace spaceOf(std::size_t rows, std::size_t columns)
{
    const std::array<hsize_t, 2> size = {rows, columns};
    return {2, size.data()};
}

/// Calls f(space in memory, space in the file) for each row.
template <class F>
void forEachRow(std::size_t rows, std::size_t columns, F&& f)
{
    const H5::DataSpace inMemory = spaceOf(1, columns), inFile = spaceOf(rows, columns);
    for (std::size_t r = 0; r < rows; ++r) {
        const std::array<hsize_t, 2> start = {r, 0}, count = {1, columns};
        inFile.selectHyperslab(H5S_SELECT_SET, count.data(), start.data());
        f(r, inMemory, inFile);
    }
}

}  // namespace

struct Hdf5Writer::File {
    H5::H5File file;
    H5::LinkCreatPropList making;

    H5::DataSet make(const std::string& name, std::string_view unit, NumberType type, const H5::DataSpace& space)
    {
        const H5::DataSet set = file.createDataSet(name, typeOf(type), space, H5::DSetCreatPropList::DEFAULT, H5::DSetAccPropList::DEFAULT, making);
        const H5::StrType text(H5::PredType::C_S1, std::max<std::size_t>(1, unit.size()));
        set.createAttribute("unit", text, H5::DataSpace()).write(text, std::string(unit));
        return set;
    }
};

Hdf5Writer::Hdf5Writer()
{
    withReason("HDF5", [&] {
        file_ = std::make_unique<File>(File{H5::H5File("checkpoint", H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, inMemory()), {}});
        file_->making.setCreateIntermediateGroup(true);
    });
}

Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::table(const std::string& name, std::string_view unit, NumberType type, std::size_t rows, std::size_t columns, const void* numbers)
{
    withReason(name, [&] {
        const H5::DataSet set = file_->make(name, unit, type, spaceOf(rows, columns));
        if (rows * columns > 0) set.write(numbers, typeOf(type));
    });
}

void Hdf5Writer::table(const std::string& name, std::string_view unit, NumberType type, std::size_t rows, std::size_t columns,
                       const std::function<const void*(std::size_t)>& row)
{
    withReason(name, [&] {
        const H5::DataSet set = file_->make(name, unit, type, spaceOf(rows, columns));
        if (rows * columns > 0)
            forEachRow(rows, columns,
                       [&](std::size_t r, const H5::DataSpace& memory, const H5::DataSpace& file) { set.write(row(r), typeOf(type), memory, file); });
    });
}

void Hdf5Writer::text(const std::string& name, const std::string& content)
{
    table(name, "text", NumberType::Byte, 1, content.size(), content.data());
}

std::string Hdf5Writer::finish()
{
    return withReason("HDF5", [&] {
        file_->file.flush(H5F_SCOPE_GLOBAL);
        std::string image(static_cast<std::size_t>(H5Fget_file_image(file_->file.getId(), nullptr, 0)), '\0');
        if (H5Fget_file_image(file_->file.getId(), image.data(), image.size()) < 0) throw std::bad_alloc();
        file_.reset();
        return image;
    });
}

std::string hdf5Version()
{
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    return fmt::format("{}.{}.{}", major, minor, release);
}

struct Hdf5Reader::File {
    H5::H5File file;

    H5::DataSet open(const std::string& name, NumberType type, std::size_t rows, std::size_t columns) const
    {
        const H5::DataSet set = file.openDataSet(name);
        if (sizeOf(set) != std::array{rows, columns})
            throw std::runtime_error(fmt::format("{} has {} x {} numbers, not {} x {}", name, sizeOf(set)[0], sizeOf(set)[1], rows, columns));
        if (!(set.getDataType() == typeOf(type))) throw std::runtime_error(fmt::format("{} has numbers of another type", name));
        return set;
    }
    static std::array<std::size_t, 2> sizeOf(const H5::DataSet& set)
    {
        const H5::DataSpace space = set.getSpace();
        if (space.getSimpleExtentNdims() != 2) throw std::runtime_error("a table of other than two dimensions");
        std::array<hsize_t, 2> size = {};
        space.getSimpleExtentDims(size.data());
        return {size[0], size[1]};
    }
};

Hdf5Reader::Hdf5Reader(std::string_view image)
{
    withReason("HDF5", [&] {
        file_ = std::make_unique<File>(File{H5::H5File("checkpoint", H5F_ACC_RDONLY, H5::FileCreatPropList::DEFAULT, inMemory(image))});
    });
}

Hdf5Reader::~Hdf5Reader() = default;

bool Hdf5Reader::has(const std::string& name) const
try {
    return file_->file.nameExists(name);
} catch (const H5::Exception&) {
    return false;  // a group on its way is missing
}

std::array<std::size_t, 2> Hdf5Reader::size(const std::string& name) const
{
    return withReason(name, [&] { return File::sizeOf(file_->file.openDataSet(name)); });
}

void Hdf5Reader::table(const std::string& name, NumberType type, std::size_t rows, std::size_t columns, void* numbers) const
{
    withReason(name, [&] {
        const H5::DataSet set = file_->open(name, type, rows, columns);
        if (rows * columns > 0) set.read(numbers, typeOf(type));
    });
}

void Hdf5Reader::table(const std::string& name, NumberType type, std::size_t rows, std::size_t columns,
                       const std::function<void*(std::size_t)>& row) const
{
    withReason(name, [&] {
        const H5::DataSet set = file_->open(name, type, rows, columns);
        if (rows * columns > 0)
            forEachRow(rows, columns,
                       [&](std::size_t r, const H5::DataSpace& memory, const H5::DataSpace& file) { set.read(row(r), typeOf(type), memory, file); });
    });
}

std::string Hdf5Reader::text(const std::string& name) const
{
    std::string content(size(name)[1], '\0');
    table(name, NumberType::Byte, 1, content.size(), content.data());
    return content;
}

}  // namespace app
