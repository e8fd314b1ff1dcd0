#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace app {

/// The file that a program's name stands for: itself with a slash in it, else the first of that name along PATH.
std::optional<std::filesystem::path> findProgram(const std::string& name);

/// A word as a shell reads it back.
std::string shellQuoted(const std::string& text);

/// How a child ended.
struct ChildExit {
    int code = 0;           ///< exit code; 128 + n if signal n ended it
    std::string errorText;  ///< what it wrote to its standard error, if that was kept
    bool ok() const { return code == 0; }
    /// The last line of errorText that says something, for one-line messages.
    std::string lastWords() const;
};

struct ChildOptions {
    std::filesystem::path folder;  ///< where it runs; empty: here
    bool quiet = true;             ///< keep standard error in ChildExit and drop standard output; else both are ours
    bool feed = false;             ///< whether its standard input comes from write(); else there is none
};

/// Another program, started with arguments as they are: no shell looks at them. It is ended when this process ends.
/// A program that runs in a process group of its own, so that Ctrl-C reaches it through us alone.
class ChildProcess {
 public:
    /// @param program  a file, as findProgram() gives
    ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildOptions& options = {});
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Hand the child all of these bytes. False when it has stopped reading: wait() tells why.
    bool write(std::span<const std::uint8_t> bytes);

    /// Close its input and wait for its end. A wish to stop (interrupt.h) is passed on to it once.
    ChildExit wait();

    /// Has it ended? A wish to stop (interrupt.h) is passed on to it once.
    std::optional<ChildExit> poll();

    /// End it at once; wait() and poll() still tell.
    void kill();

 private:
    pid_t id_ = -1;
    bool passedOn_ = false;  ///< whether a wish to stop was passed on
    int input_ = -1, errors_ = -1;
};

/// Start, wait.
ChildExit runChild(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildOptions& options = {});

}  // namespace app
