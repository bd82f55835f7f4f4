// Helpers: each part of a loop once, loops in loops, helpers that come late, forked processes.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <set>
#include <thread>
#include <vector>

#if !defined(_WIN32)
    #include <sys/wait.h>
    #include <unistd.h>
#endif

#include "check.hpp"
#include "umform/assembly/helpers.hpp"

using namespace umform;

namespace {

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

/// Where so many threads wait for each other, for ten seconds at most.
class Meeting {
  public:
    explicit Meeting(int threads) : threads_(threads) {}
    void come() {
        ++here_;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (here_ < threads_ && std::chrono::steady_clock::now() < end) rest();
    }

  private:
    int threads_;
    std::atomic<int> here_{0};
};

/// Shares parts 0 ... count - 1; the numbers of the threads that took any.
std::set<int> shared(int threads, int count, const std::function<void(int)>& part) {
    std::atomic<int> next{0};
    std::vector<std::atomic<int>> took(threads);
    Helpers::share(threads, [&](int thread) {
        for (int k = next++; k < count; k = next++) part(k), ++took[thread];
    });
    std::set<int> found;
    for (int thread = 0; thread < threads; ++thread)
        if (took[thread] > 0) found.insert(thread);
    return found;
}

void check_parts() {
    for (const int threads : {1, 2, 5})
        for (const int count : {0, 1, 40}) {
            std::vector<std::atomic<int>> visits(count);
            Meeting meeting(threads);
            const std::set<int> found = shared(threads, count, [&](int k) {
                ++visits[k];
                if (count == 40 && k < threads) meeting.come();
            });
            for (const auto& visit : visits) CHECK(visit == 1);
            CHECK(static_cast<int>(found.size()) <= std::min(threads, count));
            if (count == 40) CHECK(static_cast<int>(found.size()) == threads);
        }
}

/// A helper that another loop keeps is not waited for.
void check_late_helpers() {
    std::atomic<int> kept{0};
    std::atomic<bool> over{false};
    std::thread other([&] {
        Helpers::share(5, [&](int thread) {  // all helpers that there are
            kept += thread == 0 ? 0 : 1;
            while (!over) rest();
        });
    });
    while (kept < 4) rest();
    for (int round = 0; round < 100; ++round) {
        int sum = 0;
        Helpers::share(1 + round % 2, [&](int thread) { sum += thread == 0 ? 1 : 0; });
        CHECK(sum == 1);
    }
    CHECK(!over);
    over = true;
    other.join();
}

/// A loop in a part of a loop is shared by those that have nothing left to do, also by the thread that waits for the end.
void check_loops_in_loops() {
    Helpers::share(8, [](int) {});  // from now on there are seven helpers
    for (const int threads : {2, 3}) {
        std::set<int> inner;
        Meeting outside(threads), inside(threads);
        shared(threads, threads, [&](int k) {
            outside.come();
            if (k < threads - 1) return;
            inner = shared(threads, threads, [&](int) { inside.come(); });
        });
        CHECK(static_cast<int>(inner.size()) == threads);
    }
}

/// It gets no helper beyond those of the outer loop, though some sleep.
void check_number_of_threads() {
    Meeting outside(2), end(2);
    std::set<int> inner;
    shared(2, 2, [&](int k) {
        outside.come();
        if (k == 1) inner = shared(2, 20, [](int) { rest(); });
        end.come();
    });
    CHECK(inner.size() == 1);
}

#if !defined(_WIN32)
/// A forked process has no helpers, and gets its own.
void check_fork() {
    Helpers::share(2, [](int) {});
    const pid_t child = fork();
    if (child == 0) {
        Meeting meeting(2);
        _exit(shared(2, 2, [&](int) { meeting.come(); }).size() == 2 ? 0 : 1);
    }
    int status = -1;
    CHECK(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}
#else
void check_fork() {}
#endif

}  // namespace

int main() {
    check_parts();
    check_late_helpers();
    check_loops_in_loops();
    check_number_of_threads();
    check_fork();
    return report("helpers");
}
