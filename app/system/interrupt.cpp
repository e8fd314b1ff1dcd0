#include "app/system/interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace app {

namespace {

// A signal handler reaches nothing but statics.
std::atomic<int> interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void countInterrupt(int signal)
{
    if (interrupts.fetch_add(1) > 0) _exit(128 + signal);
}

}  // namespace

void watchForInterrupt()
{
    interrupts = 0;
    struct sigaction action = {};
    action.sa_handler = countInterrupt;
    action.sa_flags = 0;  // a waiting call returns early, so that a parent can pass the wish on to its child
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

int interruptsSeen() { return interrupts.load(); }
bool stopWanted() { return interruptsSeen() > 0; }

}  // namespace app
