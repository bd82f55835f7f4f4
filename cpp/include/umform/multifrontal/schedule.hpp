// Which fronts a thread works on alone, and which wait for several: the same for any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "umform/assembly/threads.hpp"
#include "umform/multifrontal/panels.hpp"
#include "umform/multifrontal/plan.hpp"
#include "umform/multifrontal/storage.hpp"

namespace umform::multifrontal {

/// Small subtrees are units, each worked through by one thread; fronts above them start when the last of their children has
/// come. What is summed up in which order depends on the tree alone.
class Schedule {
  public:
    struct Unit {
        int begin, root;  // fronts begin ... root
    };
    std::vector<Unit> units;
    std::vector<std::uint8_t> above;  // [front] is it above the units?
    std::vector<std::uint8_t> depth;  // even or odd
    std::size_t stacks = 0;           // numbers in the two stacks of a unit, at most
    std::size_t peak = 0;             // numbers in stacks and updates at one time, on one thread
    std::int64_t work = 0;            // multiplications of a factorisation

    /// Where the memory for updates begins and ends: behind the factors and, where all fronts have one ancestor, in its columns
    /// until they are assembled. What that front takes over lies behind `floor`.
    std::size_t begin = 0, floor = 0, end = 0;
    int last = -1;  // that ancestor

    explicit Schedule(const Plan& plan) : above(plan.fronts.size(), 0), depth(plan.fronts.size(), 0) {
        const int count = static_cast<int>(plan.fronts.size());
        for (const Front& front : plan.fronts)
            if (front.parent < 0) work += front.work;
        const std::int64_t limit = std::max(kUnit, work / kUnits);
        std::vector<std::int32_t> first(count);
        for (int f = 0; f < count; ++f)
            first[f] =
                plan.children_start[f] < plan.children_start[f + 1] ? first[plan.children[plan.children_start[f]]] : f;
        for (int f = count - 1; f >= 0; --f) {
            const int parent = plan.fronts[f].parent;
            if (parent >= 0) depth[f] = depth[parent] ^ 1U;
            above[f] = plan.fronts[f].work > limit && first[f] < f ? 1 : 0;
        }
        for (int f = 0; f < count; ++f) {
            const int parent = plan.fronts[f].parent;
            if (above[f] == 0 && (parent < 0 || above[parent] != 0)) units.push_back({first[f], f});
        }
        for (const Unit& unit : units) measure(plan, unit);
        find_peak(plan);
        place(plan);
    }

    /// A solution takes some tens of microseconds below this, and BLAS needs no buffers.
    bool is_large() const { return work > kLarge; }
    /// Threads that share a factorisation, and a solution, of those that there are.
    int factoring(int threads) const { return work > kSmall ? threads : 1; }
    int solving(int threads) const { return is_large() ? threads : 1; }

    /// Side of the memory for updates from which that of a front is taken.
    bool side(int f) const { return depth[f] != 0; }

    /// Calls alone(unit, thread) for each unit and together(front, thread) for each front above, children first.
    template <class Alone, class Together>
    void run(const Plan& plan, int team, const Alone& alone, const Together& together) const {
        std::vector<std::atomic<std::int32_t>> missing(plan.fronts.size());
        for (std::size_t f = 0; f < plan.fronts.size(); ++f)
            missing[f] = plan.children_start[f + 1] - plan.children_start[f];
        for_each(static_cast<int>(units.size()), team, 1, [&](int k, int thread) {
            alone(units[k], thread);
            for (int f = plan.fronts[units[k].root].parent; f >= 0 && --missing[f] == 0; f = plan.fronts[f].parent)
                together(f, thread);
        });
    }

    /// Calls alone(unit, thread) for each unit.
    template <class Alone>
    void run_units(int team, const Alone& alone) const {
        for_each(static_cast<int>(units.size()), team, 1, [&](int k, int thread) { alone(units[k], thread); });
    }

  private:
    static constexpr std::int64_t kSmall = 2'000'000, kLarge = 20'000'000, kUnit = 1'000'000;  // multiplications
    static constexpr std::int64_t kUnits = 48;

    void find_peak(const Plan& plan) {
        std::size_t held = 0, unit = 0;
        for (int f = 0; f < static_cast<int>(plan.fronts.size()); ++f) {
            if (above[f] != 0) {
                held += Arena::padded(update_size(plan, f));
                peak = std::max(peak, held);
                held -= taken_over(plan, f);
            } else if (f == units[unit].root) {
                held += Arena::padded(update_size(plan, f));
                peak = std::max(peak, held + Arena::padded(stacks));
                ++unit;
            }
        }
    }

    /// Numbers in the updates of the children of a front.
    static std::size_t taken_over(const Plan& plan, int f) {
        std::size_t sum = 0;
        for (int k = plan.children_start[f]; k < plan.children_start[f + 1]; ++k)
            sum += Arena::padded(update_size(plan, plan.children[k]));
        return sum;
    }

    void place(const Plan& plan) {
        const int count = static_cast<int>(plan.fronts.size());
        const auto roots = std::count_if(plan.fronts.begin(), plan.fronts.end(), [](auto& f) { return f.parent < 0; });
        floor = begin = Arena::padded(plan.factor_size);
        if (roots == 1 && above[count - 1] != 0) {
            last = count - 1;
            begin = Arena::padded(plan.fronts[last].factor);
        }
        end = std::max(begin + peak, floor + (last < 0 ? 0 : taken_over(plan, last)));
    }

    static std::size_t update_size(const Plan& plan, int f) {
        return Panels::of_update(plan.fronts[f].updates(), 0, plan.symmetric).size();
    }

    /// What the stacks of a unit hold at most.
    void measure(const Plan& plan, const Unit& unit) {
        std::size_t held = 0;
        for (int f = unit.begin; f <= unit.root; ++f) {
            if (f < unit.root) held += update_size(plan, f);
            stacks = std::max(stacks, held);
            for (int k = plan.children_start[f]; k < plan.children_start[f + 1]; ++k)
                held -= update_size(plan, plan.children[k]);
        }
    }
};

}  // namespace umform::multifrontal
