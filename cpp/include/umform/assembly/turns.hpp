// The order in which elements are added, and which of them wait for which.
#pragma once

#include <atomic>
#include <span>
#include <thread>

#include "umform/assembly/colours.hpp"
#include "umform/assembly/threads.hpp"

namespace umform {

/// Facets in a group: most are far from the tool, and cost little.
inline constexpr int facets_of_a_turn = 16;

/// Groups of up to `width` elements of one colour, colour after colour. Threads take them in this order and work on them at the
/// same time; a group is added when the earlier ones at its nodes are, so that every sum is formed in the same order with any
/// number of threads. eq. (5.15)
class Turns {
  public:
    Turns(const Connectivity& part, const Colours& colours, int width) {
        for (const auto& colour : colours)
            for (std::size_t first = 0; first < colour.size(); first += width) {
                const std::size_t last = std::min(first + width, colour.size());
                elements_.insert(elements_.end(), colour.begin() + first, colour.begin() + last);
                first_.push_back(elements_.size());
            }
        find_earlier(part);
        added_ = std::vector<std::atomic<std::uint32_t>>(size());
    }

    int size() const { return static_cast<int>(first_.size()) - 1; }
    std::span<const std::int32_t> elements(int group) const { return part_of(elements_, first_, group); }
    /// The earlier groups at the nodes of a group: all of them, since one that adds nothing waits for no other.
    std::span<const std::int32_t> earlier(int group) const { return part_of(earlier_, first_earlier_, group); }

    /// Calls work(group, thread, turn) for every group, on so many `threads`; thread < threads. turn() returns when the earlier
    /// groups at the nodes of the group are added: it is called before anything is added there.
    template <class Work>
    void run(int threads, const Work& work) {
        ++round_;
        const int count = size(), chunk = std::max(1, count / (shares * threads));
        FirstException exception;
        for_each(count, threads, chunk, [&](int first, int thread) {
            for (int group = first; group < std::min(first + chunk, count); ++group) {
                exception.guard([&] { work(group, thread, [&] { wait(group); }); });
                added_[group].store(round_, std::memory_order_release);  // after an exception too: others wait for it
            }
        });
        exception.rethrow();
    }

  private:
    /// Shares that each thread takes one after the other: they even out work that differs. All threads together work on a small
    /// part of a colour, so that they seldom wait.
    static constexpr int shares = 32;

    template <class T>
    static std::span<const T> part_of(const std::vector<T>& all, const std::vector<std::size_t>& first, int group) {
        return {all.data() + first[group], first[group + 1] - first[group]};
    }

    void find_earlier(const Connectivity& part) {
        const int nodes = part.ids.empty() ? 0 : 1 + *std::max_element(part.ids.begin(), part.ids.end());
        std::vector<std::vector<std::int32_t>> at(nodes);  // groups at a node so far
        for (int group = 0; group < size(); ++group) {
            std::vector<std::int32_t> found;
            for (const std::int32_t e : elements(group))
                for (int a = 0; a < part.nodes; ++a) {
                    std::vector<std::int32_t>& there = at[part[e][a]];
                    for (const std::int32_t here : there)
                        if (here != group) found.push_back(here);
                    if (there.empty() || there.back() != group) there.push_back(group);
                }
            std::sort(found.begin(), found.end());
            earlier_.insert(earlier_.end(), found.begin(), std::unique(found.begin(), found.end()));
            first_earlier_.push_back(earlier_.size());
        }
    }

    /// It begins and ends with work that another thread does now, which is done soon.
    void wait(int group) const {
        for (const std::int32_t other : earlier(group))
            while (added_[other].load(std::memory_order_acquire) != round_) std::this_thread::yield();
    }

    std::vector<std::int32_t> elements_, earlier_;
    std::vector<std::size_t> first_{0}, first_earlier_{0};  // [group] -> its part of them
    std::vector<std::atomic<std::uint32_t>> added_;         // [group] the last round in which it was
    std::uint32_t round_ = 0;
};

}  // namespace umform
