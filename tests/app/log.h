#pragma once

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>
#include <string>

namespace app::test {

/// What is logged as long as this object is there.
class Log {
 public:
    Log() { spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(words_))); }
    ~Log() { spdlog::set_default_logger(before_); }
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;
    std::string words() const { return words_.str(); }

 private:
    std::ostringstream words_;
    std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
};

}  // namespace app::test
