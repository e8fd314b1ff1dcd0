#include "app/system/progress.h"

#include "app/system/stopwatch.h"

#include <fmt/format.h>

#include <cmath>

#include <unistd.h>

namespace app {

namespace {

constexpr double kSecondsBetweenRedraws = 0.2;
constexpr double kSecondsBetweenLines = 5.0;
constexpr double kStepSmoothing = 0.1;  ///< weight of the newest step in s/step [-]

/// "1.9e-4": one digit of exponent where one is enough.
std::string shortNumber(double value)
{
    std::string text = fmt::format("{:.1e}", value);
    const auto exponent = text.find('e');
    if (exponent != std::string::npos && text.size() == exponent + 4 && text[exponent + 2] == '0') text.erase(exponent + 2, 1);
    return text;
}

}  // namespace

std::string formatDuration(double seconds)
{
    const auto total = static_cast<std::int64_t>(std::llround(seconds));
    if (total < 60) return fmt::format("{} s", total);
    if (total < 3600) return fmt::format("{} m {:02d} s", total / 60, total % 60);
    return fmt::format("{} h {:02d} m", total / 3600, total % 3600 / 60);
}

double secondsLeft(double begin, double now, double end, double wallSeconds)
{
    if (!(now > begin)) return -1.0;
    return std::max(0.0, end - now) * wallSeconds / (now - begin);
}

std::string progressLine(const ProgressState& state)
{
    const std::string line =
        fmt::format("frame {}/{} · t {:.4g} s · dt {} · {:.3f} s/step · ETA {}", state.frame, state.frames, state.time, shortNumber(state.dt),
                    state.secondsPerStep, state.secondsLeft < 0.0 ? "?" : formatDuration(state.secondsLeft));
    return state.allSecondsLeft < 0.0 ? line : fmt::format("{}, with those to follow {}", line, formatDuration(state.allSecondsLeft));
}

Progress::Progress(std::FILE* out, std::string label, double begin, double end, std::int64_t frames, std::int64_t frame)
    : out_(out),
      label_(std::move(label)),
      begin_(begin),
      end_(end),
      terminal_(isatty(fileno(out)) == 1),
      start_(std::chrono::steady_clock::now()),
      shown_(start_)
{
    state_.frame = frame;
    state_.frames = frames;
    state_.time = begin;
}

Progress::~Progress()
{
    if (lineOpen_) std::fputc('\n', out_);
}

void Progress::stepDone(double time, double dt, double stepSeconds)
{
    state_.time = time;
    state_.dt = dt;
    state_.secondsPerStep = state_.secondsPerStep > 0.0 ? std::lerp(state_.secondsPerStep, stepSeconds, kStepSmoothing) : stepSeconds;
    if (secondsSince(shown_) >= (terminal_ ? kSecondsBetweenRedraws : kSecondsBetweenLines)) show();
}

void Progress::show()
{
    shown_ = std::chrono::steady_clock::now();
    const double wallSeconds = secondsSince(start_);
    state_.secondsLeft = secondsLeft(begin_, state_.time, end_, wallSeconds);
    if (runsToFollow_ > 0.0 && state_.secondsLeft >= 0.0)
        state_.allSecondsLeft = state_.secondsLeft + runsToFollow_ * (wallSeconds + state_.secondsLeft);
    const std::string line = (label_.empty() ? "" : label_ + "  ") + progressLine(state_);
    // \033[K wipes what an earlier, longer line left behind.
    if (terminal_) fmt::print(out_, "\r{}\033[K", line);
    else fmt::print(out_, "{}\n", line);
    std::fflush(out_);
    lineOpen_ = terminal_;
}

}  // namespace app
