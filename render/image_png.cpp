#include "render/image.h"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

// libpng and not stb: at its lowest compression it is several times quicker, and its files are smaller.

namespace render {

namespace {

namespace fs = std::filesystem;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void failPng(const char* verb, const fs::path& path, const std::string& reason)
{
    throw std::runtime_error("cannot " + std::string(verb) + " picture " + path.string() + ": " + reason);
}

/// libpng wants an error function that does not return; it may not throw through C frames, so it jumps.
void storeErrorAndJump(png_structp png, png_const_charp message)
{
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// Everything between setjmp and longjmp: plain C, no objects with destructors. False if libpng gave up.
bool encode(png_structp png, png_infop info, const Image& image, std::span<png_text> texts, std::FILE* file)
{
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_set_compression_level(png, 1);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
    png_write_end(png, info);
    return true;
}

/// The texts as libpng takes them, which is without const.
std::vector<png_text> lendTexts(PngTexts& texts)
{
    std::vector<png_text> lent;
    for (auto& [keyword, text] : texts) {
        png_text& one = lent.emplace_back();
        one.compression = PNG_TEXT_COMPRESSION_NONE;
        one.key = keyword.data();
        one.text = text.data();
        one.text_length = text.size();
    }
    return lent;
}

void writeTo(std::FILE* file, const Image& image, PngTexts texts, const fs::path& path)
{
    std::vector<png_text> lent = lendTexts(texts);
    std::string reason;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &reason, storeErrorAndJump, ignoreWarning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    errno = 0;
    const bool written = info != nullptr && encode(png, info, image, lent, file);
    const int systemError = errno;
    png_destroy_write_struct(&png, &info);
    if (!written && systemError != 0) reason = std::strerror(systemError);
    if (!written) failPng("write", path, reason.empty() ? "no memory" : reason);
    errno = 0;
    if (std::fflush(file) != 0 || std::ferror(file)) failPng("write", path, std::strerror(errno));
}

}  // namespace

void writePng(const Image& image, const fs::path& path, const PngTexts& texts)
{
    if (image.width <= 0 || image.height <= 0) failPng("write", path, "it is empty");
    const fs::path partial = fs::path(path).concat(".partial");
    File file(std::fopen(partial.c_str(), "wb"));
    if (!file) failPng("write", path, std::strerror(errno));
    try {
        writeTo(file.get(), image, texts, path);
        if (std::fclose(file.release()) != 0) failPng("write", path, std::strerror(errno));
        std::error_code error;
        fs::rename(partial, path, error);
        if (error) failPng("write", path, error.message());
    } catch (...) {
        std::error_code ignored;
        fs::remove(partial, ignored);
        throw;
    }
}

Image readPng(const fs::path& path)
{
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) failPng("read", path, std::strerror(errno));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_stdio(&png, file.get())) failPng("read", path, png.message);
    png.format = PNG_FORMAT_RGB;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height));
    const png_color white = {255, 255, 255};
    if (!png_image_finish_read(&png, &white, image.pixels.data(), 0, nullptr)) failPng("read", path, png.message);
    return image;
}

}  // namespace render
