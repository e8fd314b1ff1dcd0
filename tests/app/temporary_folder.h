#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace app::test {

/// A folder of the test's own that is gone when the test is.
class TemporaryFolder {
 public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "drench_test_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
    std::filesystem::path path_;
};

inline std::string contentOf(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}

inline std::vector<std::string> linesOf(const std::filesystem::path& file)
{
    std::istringstream in(contentOf(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

inline void writeFile(const std::filesystem::path& file, const std::string& content) { std::ofstream(file, std::ios::binary) << content; }

/// Sets an environment variable until the end of the scope.
class EnvironmentVariable {
 public:
    EnvironmentVariable(const char* name, const std::string& value) : name_(name), old_(std::getenv(name) ? std::getenv(name) : "")
    {
        setenv(name, value.c_str(), 1);
    }
    ~EnvironmentVariable() { setenv(name_, old_.c_str(), 1); }
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
    const char* name_;
    std::string old_;
};

}  // namespace app::test
