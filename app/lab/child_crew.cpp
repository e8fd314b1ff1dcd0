#include "app/lab/child_crew.h"

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

    Member(std::size_t n, const Crew& crew) : number(n), child(crew.program, crew.arguments(n)) {}
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start).count(); }
};

/// Takes those out that have ended, and ends those that take too long.
void lookAfter(std::list<Member>& members, const Crew& crew)
{
    for (auto member = members.begin(); member != members.end();) {
        const auto exit = member->child.poll();
        if (!exit) {
            if (!member->timedOut && member->seconds() > crew.limitSeconds) {
                member->child.kill();
                member->timedOut = true;
            }
            ++member;
            continue;
        }
        crew.ended(member->number, {*exit, member->seconds(), member->timedOut});
        member = members.erase(member);
    }
}

}  // namespace

void runCrew(const Crew& crew)
{
    std::list<Member> members;
    const auto width = static_cast<std::size_t>(std::max(1, crew.width));
    for (std::size_t next = 0; next < crew.count || !members.empty();) {
        if (crew.stopWanted()) next = crew.count;
        for (; next < crew.count && members.size() < width; ++next) members.emplace_back(next, crew);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        lookAfter(members, crew);
    }
}

}  // namespace app
