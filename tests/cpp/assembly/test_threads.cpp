// Loops over a team: the first exception, and a number of threads that changes meanwhile.
#include <numeric>

#include "check.hpp"
#include "umform/assembly/threads.hpp"

using namespace umform;

namespace {

void check_ranges() {
    for (const int count : {0, 1, 63, 64, 65, 1000})
        for (const int threads : {1, 3}) {
            std::vector<int> visits(count);
            for_each_range(count, threads, [&](int first, int last) {
                for (int k = first; k < last; ++k) ++visits[k];
            });
            CHECK(visits == std::vector<int>(count, 1));
        }
}

void check_exceptions() {
    std::vector<std::int32_t> all(1000);
    std::iota(all.begin(), all.end(), 0);
    const auto failing = [](int element, int) {
        if (element == 500) throw std::runtime_error("500");
    };
    CHECK(throws<std::runtime_error>([&] { for_each_by_colour({all}, 3, failing); }));
    CHECK(
        throws<std::runtime_error>([&] { for_each_range(1000, 3, [&](int first, int) { failing(first + 52, 0); }); }));
}

/// A team has as many threads as it was given, whatever is set while it works: there are no more workspaces.
void check_team() {
    std::vector<std::int32_t> all(1000);
    std::iota(all.begin(), all.end(), 0);
    const int before = thread_count();
    std::atomic<int> largest{0};
    thread_count() = 1;
    for_each_by_colour({all, all, all}, 2, [&](int, int thread) {
        thread_count() = 7;
        for (int seen = largest; thread > seen && !largest.compare_exchange_weak(seen, thread);) {
        }
    });
    CHECK(largest <= 1);
    thread_count() = before;
}

}  // namespace

int main() {
    check_ranges();
    check_exceptions();
    check_team();
    return report("threads");
}
