// Number of threads of all kernels, and loops that give the same bits for any number of them.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <vector>

#ifdef _OPENMP
    #include <omp.h>
#endif

namespace umform {

/// Number of threads of evaluations to come. An evaluation reads it once: another thread may change it at any time.
inline std::atomic<int>& thread_count() {
#ifdef _OPENMP
    static std::atomic<int> count{omp_get_max_threads()};
#else
    static std::atomic<int> count{1};
#endif
    return count;
}

inline int thread_index() {
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/// Keeps the first exception of a team (a user's function may throw), which ends the work and is thrown again outside of it.
class FirstException {
  public:
    template <class Work>
    void guard(const Work& work) {
        if (stopped_.load(std::memory_order_relaxed)) return;
        try {
            work();
        } catch (...) {
            stopped_ = true;
#pragma omp critical
            if (!thrown_) thrown_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }

  private:
    std::exception_ptr thrown_;
    std::atomic<bool> stopped_{false};
};

/// Starting a team for fewer of them costs more than it brings: some 20 us. A Gauss point takes .4 to 1.2 us, a facet near a tool
/// one.
inline constexpr int points_worth_a_team = 256, facets_worth_a_team = 128, nodes_worth_a_team = 8192;

/// Calls work(first, last) for fixed ranges of 0 .. count - 1, independent of the number of threads.
template <class Work>
void for_each_range(int count, int threads, const Work& work) {
    constexpr int length = 32;
    FirstException exception;
    [[maybe_unused]] const int team = threads;
#pragma omp parallel for num_threads(team) if (team > 1) schedule(dynamic)
    for (int first = 0; first < count; first += length)
        exception.guard([&] { work(first, std::min(first + length, count)); });
    exception.rethrow();
}

}  // namespace umform
