#include "app/system/process_pool.h"

#include <algorithm>
#include <chrono>
#include <list>
#include <thread>

namespace app {

namespace {

using Clock = std::chrono::steady_clock;

struct Member {
    std::size_t number;
    Clock::time_point start = Clock::now();
    ChildProcess child;
    bool timedOut = false;

    Member(std::size_t n, const ProcessPool& pool) : number(n), child(pool.program, pool.arguments(n)) {}
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start).count(); }
};

/// Takes those out that have ended, and ends those that take too long.
void pollMembers(std::list<Member>& members, const ProcessPool& pool)
{
    for (auto member = members.begin(); member != members.end();) {
        const auto exit = member->child.poll();
        if (!exit) {
            if (!member->timedOut && member->seconds() > pool.limitSeconds) {
                member->child.kill();
                member->timedOut = true;
            }
            ++member;
            continue;
        }
        pool.ended(member->number, {*exit, member->seconds(), member->timedOut});
        member = members.erase(member);
    }
}

}  // namespace

void runProcesses(const ProcessPool& pool)
{
    std::list<Member> members;
    const auto width = static_cast<std::size_t>(std::max(1, pool.width));
    for (std::size_t next = 0; next < pool.count || !members.empty();) {
        if (pool.stopWanted()) next = pool.count;
        for (; next < pool.count && members.size() < width; ++next) members.emplace_back(next, pool);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        pollMembers(members, pool);
    }
}

}  // namespace app
