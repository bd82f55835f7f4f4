// Number of threads of all kernels, and loops that give the same bits for any number of them.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>

#include "umform/assembly/helpers.hpp"

namespace umform {

/// Number of threads of evaluations to come. An evaluation reads it once: another thread may change it at any time.
inline std::atomic<int>& thread_count() {
    static std::atomic<int> count{std::max(1, static_cast<int>(std::thread::hardware_concurrency()))};
    return count;
}

/// Keeps the first exception of a loop (a user's function may throw), which ends the work and is thrown again outside of it.
class FirstException {
  public:
    template <class Work>
    void guard(const Work& work) {
        if (stopped_.load(std::memory_order_relaxed)) return;
        try {
            work();
        } catch (...) {
            if (!stopped_.exchange(true)) thrown_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }

  private:
    std::exception_ptr thrown_;
    std::atomic<bool> stopped_{false};
};

/// Sharing fewer of them costs more than it brings: some 15 us. A Gauss point takes .4 to 1.2 us, a facet near a tool
/// one.
inline constexpr int points_worth_a_team = 256, facets_worth_a_team = 128, nodes_worth_a_team = 8192;

/// Calls work(k, thread) for k = 0, step, 2 step, ... below a count, on so many `threads`; thread < threads.
template <class Work>
void for_each(int count, int threads, int step, const Work& work) {
    FirstException exception;
    std::atomic<int> next{0};
    Helpers::share(threads, [&](int thread) {
        for (int k = next.fetch_add(step); k < count; k = next.fetch_add(step))
            exception.guard([&] { work(k, thread); });
    });
    exception.rethrow();
}

/// Calls work(first, last) for fixed ranges of 0 .. count - 1, independent of the number of threads.
template <class Work>
void for_each_range(int count, int threads, const Work& work) {
    constexpr int length = 32;
    for_each(count, threads, length, [&](int first, int) { work(first, std::min(first + length, count)); });
}

}  // namespace umform
