// Threads that help with a loop, and are not waited for where they come late.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <system_error>
#include <thread>

#if !defined(_WIN32)
    #include <pthread.h>
#endif

namespace umform {

/// The threads of a process that help with any loop. A team of OpenMP ends when each of its threads has come, and these wait
/// actively: where other programs take the processors, both cost many times what the loop does.
class Helpers {
  public:
    /// Calls work(0), and work(1), work(2), ... in up to `threads` - 1 helpers. Each call takes parts of a loop until none is left,
    /// and throws nothing. It returns when the calls that have begun are over: a helper that comes later finds nothing to do.
    template <class Work>
    static void share(int threads, const Work& work) {
        if (threads < 2) return work(0);
        Job job{[](const void* loop, int place) { (*static_cast<const Work*>(loop))(place); }, &work, threads - 1,
                now()};
        job.spare = threads - 1;
        Helpers& helpers = *all().load();
        helpers.open(job);
        job.call(0);
        helpers.close(job);
    }

  private:
    struct Job {
        void (*work)(const void*, int);
        const void* loop;
        int wanted;  // helpers that may still come
        Job* outer;  // the loop in which this one began
        Job* outermost = outer == nullptr ? this : outer->outermost;
        int spare = 0;  // of the outermost loop: helpers that it and those in it may have now
        int come = 0;
        std::atomic<int> inside{0};
        Job* next = nullptr;

        void call(int place) {
            now() = this;
            work(loop, place);
            now() = outer;
        }
    };

    static constexpr std::chrono::microseconds patience{100};  // before a thread sleeps; to wake it costs some 15

    std::mutex mutex_;  // of the jobs, less `inside`, and of `count_`
    Job* first_ = nullptr;
    int count_ = 0;  // helpers
    alignas(64) std::atomic<std::uint32_t> opened_{0};
    alignas(64) std::atomic<std::uint32_t> left_{0};

    /// The loop that this thread works on.
    static Job*& now() {
        thread_local Job* job = nullptr;
        return job;
    }

    /// Never destroyed, since helpers live as long as the process. A process that is forked has none of them, and begins anew.
    static std::atomic<Helpers*>& all() {
        static std::atomic<Helpers*> helpers{[] {
#if !defined(_WIN32)
            pthread_atfork(nullptr, nullptr, [] { all() = new Helpers; });
#endif
            return new Helpers;
        }()};
        return helpers;
    }

    void open(Job& job) {
        const int wanted = job.wanted;
        {
            const std::lock_guard lock(mutex_);
            for (; count_ < wanted; ++count_) try {
                    std::thread([this] { help(); }).detach();
                } catch (const std::system_error&) {  // no more threads: less help
                    break;
                }
            job.next = first_, first_ = &job;
        }
        opened_.fetch_add(1, std::memory_order_release);
        for (int k = 0; k < wanted; ++k) opened_.notify_one();
        if (job.outer != nullptr) wake_those_that_wait();
    }

    void close(Job& job) {
        {
            const std::lock_guard lock(mutex_);
            Job** at = &first_;
            while (*at != &job) at = &(*at)->next;
            *at = job.next;
        }
        for (;;) {
            const std::uint32_t seen = left_.load(std::memory_order_acquire);
            if (job.inside.load(std::memory_order_acquire) == 0) return;
            if (!take(&job)) wait(left_, seen);
        }
    }

    void help() {
        for (;;) {
            const std::uint32_t seen = opened_.load(std::memory_order_acquire);
            if (!take(nullptr)) wait(opened_, seen);
        }
    }

    /// Works on a loop, and whether there was any: a helper on all that have one to spare, a thread that waits for the end of a
    /// loop on those that began in it.
    bool take(const Job* awaited) {
        Job* job;
        int place;
        const int helper = awaited == nullptr ? 1 : 0;
        {
            const std::lock_guard lock(mutex_);
            job = first_;
            while (job != nullptr
                   && (job->wanted == 0 || (helper == 1 ? job->outermost->spare == 0 : job->outer != awaited)))
                job = job->next;
            if (job == nullptr) return false;
            --job->wanted, place = ++job->come, ++job->inside, job->outermost->spare -= helper;
        }
        Job* const before = now();
        job->call(place);
        now() = before;
        {
            const std::lock_guard lock(mutex_);
            job->wanted = 0, job->outermost->spare += helper;  // no part is left
        }
        job->inside.fetch_sub(1, std::memory_order_release);  // the job may end here
        wake_those_that_wait();
        return true;
    }

    void wake_those_that_wait() {
        left_.fetch_add(1, std::memory_order_release);
        left_.notify_all();
    }

    /// Waits until a counter is no longer what was seen.
    static void wait(const std::atomic<std::uint32_t>& counter, std::uint32_t seen) {
        const auto end = std::chrono::steady_clock::now() + patience;
        do
            for (int k = 0; k < 16; ++k) {
                if (counter.load(std::memory_order_acquire) != seen) return;
                pause();
            }
        while (std::chrono::steady_clock::now() < end);
        counter.wait(seen, std::memory_order_acquire);
    }

    static void pause() {
#if defined(__x86_64__)
        __builtin_ia32_pause();
#else
        std::this_thread::yield();
#endif
    }
};

}  // namespace umform
