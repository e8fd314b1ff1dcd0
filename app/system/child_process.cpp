#include "app/system/child_process.h"

#include "app/system/interrupt.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

namespace app {

namespace {

[[noreturn]] void throwCannotStart(const std::filesystem::path& program)
{
    throw std::runtime_error(fmt::format("cannot start {}: {}", program.string(), std::strerror(errno)));
}

/// The child's side of fork(): nothing here may allocate, since other threads of the parent may have held locks.
[[noreturn]] void execProgram(const char* program, char* const* arguments, const char* folder, int input, int output, int errors)
{
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    struct sigaction byDefault = {};
    byDefault.sa_handler = SIG_DFL;
    for (int signal : {SIGINT, SIGTERM, SIGPIPE}) sigaction(signal, &byDefault, nullptr);
    if (input >= 0) dup2(input, STDIN_FILENO);
    if (output >= 0) dup2(output, STDOUT_FILENO);
    if (errors >= 0) dup2(errors, STDERR_FILENO);
    if (*folder == '\0' || chdir(folder) == 0) execv(program, arguments);
    const char* reason = std::strerror(errno);
    static_cast<void>(!::write(STDERR_FILENO, reason, std::strlen(reason)));
    _exit(127);
}

std::string contentOf(int file)
{
    std::string content;
    std::array<char, 4096> piece;
    lseek(file, 0, SEEK_SET);
    for (ssize_t n; (n = read(file, piece.data(), piece.size())) > 0;) content.append(piece.data(), n);
    return content;
}

void closeOnce(int& file)
{
    if (file >= 0) close(file);
    file = -1;
}

}  // namespace

std::string shellQuoted(const std::string& text)
{
    const bool isPlain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || std::string_view("_-./=,:+").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (isPlain) return text;
    std::string all = "'";
    for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return all + "'";
}

std::optional<std::filesystem::path> findProgram(const std::string& name)
{
    const auto runnable = [](const std::filesystem::path& file) { return std::filesystem::is_regular_file(file) && access(file.c_str(), X_OK) == 0; };
    if (name.find('/') != std::string::npos) return runnable(name) ? std::optional<std::filesystem::path>(name) : std::nullopt;
    const char* path = std::getenv("PATH");
    for (std::string_view rest = path ? path : ""; !rest.empty();) {
        const auto end = std::min(rest.find(':'), rest.size());
        const auto file = std::filesystem::path(rest.substr(0, end)) / name;
        if (runnable(file)) return file;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return std::nullopt;
}

std::string ChildExit::lastWords() const
{
    const auto end = errorText.find_last_not_of(" \t\r\n");
    if (end == std::string::npos) return fmt::format("exit code {}, no message", code);
    const auto begin = errorText.find_last_of("\r\n", end);
    return errorText.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

ChildProcess::ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildOptions& options)
{
    std::string name = program.string();
    std::vector<std::string> copies(arguments);
    std::vector<char*> argv = {name.data()};
    for (auto& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);

    int sockets[2] = {-1, -1};
    if (options.feed && socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) throwCannotStart(program);
    int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (options.quiet) errors_ = memfd_create("errors of a child", MFD_CLOEXEC);
    input_ = sockets[0];

    id_ = fork();
    if (id_ == 0)
        execProgram(name.c_str(), argv.data(), options.folder.c_str(), options.feed ? sockets[1] : nowhere, options.quiet ? nowhere : -1, errors_);
    closeOnce(sockets[1]);
    closeOnce(nowhere);
    if (id_ < 0) throwCannotStart(program);
}

ChildProcess::~ChildProcess()
{
    if (id_ > 0) {
        kill();
        waitpid(id_, nullptr, 0);
    }
    closeOnce(input_);
    closeOnce(errors_);
}

bool ChildProcess::write(std::span<const std::uint8_t> bytes)
{
    while (!bytes.empty()) {
        const ssize_t n = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes = bytes.subspan(n);
    }
    return true;
}

ChildExit ChildProcess::wait()
{
    closeOnce(input_);
    for (;;) {
        if (auto end = poll()) return std::move(*end);
        const timespec pause = {0, 10'000'000};
        nanosleep(&pause, nullptr);
    }
}

std::optional<ChildExit> ChildProcess::poll()
{
    int status = 0;
    const pid_t ended = waitpid(id_, &status, WNOHANG);
    if (ended < 0) throw std::runtime_error(fmt::format("lost a child process: {}", std::strerror(errno)));
    if (ended == 0) {
        if (interruptsSeen() > 0 && !passedOn_) passedOn_ = ::kill(id_, SIGTERM) == 0;
        return std::nullopt;
    }
    id_ = -1;
    ChildExit result;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (errors_ >= 0) result.errorText = contentOf(errors_);
    return result;
}

void ChildProcess::kill()
{
    if (id_ > 0) ::kill(id_, SIGKILL);
}

ChildExit runChild(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildOptions& options)
{
    return ChildProcess(program, arguments, options).wait();
}

}  // namespace app
