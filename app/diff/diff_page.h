#pragma once

#include "app/diff/diff.h"

#include <filesystem>

namespace app {

/// Leave in a folder diff.html, one page that needs no other file, and diff_<picture>.png of every picture that differs: A, B
/// and what differs side by side. The page shows the worst pictures, a curve over all of them, and all numbers.
/// Pictures of an earlier comparison go. Throws InputError where the folder is one of those that are compared.
void writeDiffPage(const DiffResult& result, const std::filesystem::path& folder);

}  // namespace app
