// Groups of elements that are added in turn: the same order with any number of threads, exceptions, the size of the team.
#include <chrono>
#include <set>

#include "assembly/grid.hpp"
#include "check.hpp"
#include "umform/assembly/turns.hpp"

using namespace umform;

namespace {

Turns turns_of(const Connectivity& part, int width) { return {part, make_colours(part), width}; }

std::set<std::int32_t> nodes_of(const Connectivity& part, const Turns& turns, int group) {
    std::set<std::int32_t> nodes;
    for (const std::int32_t e : turns.elements(group)) nodes.insert(part[e], part[e] + part.nodes);
    return nodes;
}

void check_groups() {
    for (const int width : {1, 4, 16}) {
        const Connectivity part = grid(9, 8, 5);
        const Turns turns = turns_of(part, width);
        CHECK(turns.size() == static_cast<int>(groups_of(make_colours(part), width)));
        std::set<std::int32_t> seen;
        std::vector<std::set<std::int32_t>> nodes;
        for (int group = 0; group < turns.size(); ++group) {
            CHECK(static_cast<int>(turns.elements(group).size()) <= width);
            for (const std::int32_t e : turns.elements(group)) CHECK(seen.insert(e).second);
            nodes.push_back(nodes_of(part, turns, group));
            CHECK(nodes.back().size() == 4 * turns.elements(group).size());  // no node is shared within a group
            std::set<std::int32_t> others;
            for (const std::int32_t node : nodes.back())
                for (int other = 0; other < group; ++other)
                    if (nodes[other].contains(node)) others.insert(other);
            const auto earlier = turns.earlier(group);
            CHECK(std::vector<std::int32_t>(earlier.begin(), earlier.end())
                  == std::vector<std::int32_t>(others.begin(), others.end()));
        }
        CHECK(static_cast<int>(seen.size()) == part.size());
    }
    CHECK(turns_of({4, {}}, 4).size() == 0);
    CHECK(turns_of({4, {0, 1, 2, 2}}, 4).earlier(0).empty());  // an element that has a node twice waits for no one
}

/// Each group leaves its number at its nodes when its turn has come; early groups take longer than late ones.
void check_order() {
    const Connectivity part = grid(9, 8, 5);
    Turns turns = turns_of(part, 4);
    for (const int threads : {1, 2, 3, 7})
        for (int round = 0; round < 3; ++round) {
            std::vector<std::vector<int>> at(90);
            std::vector<int> visits(turns.size());
            turns.run(threads, [&](int group, int, const auto& turn) {
                if (group < turns.size() / 2) std::this_thread::sleep_for(std::chrono::microseconds(500 * (group % 4)));
                turn();
                ++visits[group];
                for (const std::int32_t node : nodes_of(part, turns, group)) at[node].push_back(group);
            });
            CHECK(visits == std::vector<int>(turns.size(), 1));
            for (const std::vector<int>& groups : at) CHECK(std::is_sorted(groups.begin(), groups.end()));
        }
    turns_of({4, {}}, 4).run(3, [](int, int, const auto&) { CHECK(false); });
}

/// Three elements with one common node, each a group. The second adds nothing, as facets far from a tool, and does not wait for the
/// first; the third does.
void check_group_that_adds_nothing() {
    Turns turns = turns_of({2, {0, 1, 0, 2, 0, 3}}, 1);
    CHECK(turns.size() == 3);
    std::atomic<bool> added{false};
    bool waited = false;
    turns.run(2, [&](int group, int, const auto& turn) {
        if (group == 1) return;
        turn();
        if (group == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (group == 0) added = true;
        if (group == 2) waited = added;
    });
    CHECK(waited);
}

/// Times as fast as one thread, where each group takes as long as any other, and nothing else takes any time.
double faster(const Turns& turns, int threads) {
    std::vector<double> free(threads, 0.0), added(turns.size());
    for (int group = 0; group < turns.size(); ++group) {
        double& thread = *std::min_element(free.begin(), free.end());
        thread += 1.0;
        for (const std::int32_t other : turns.earlier(group)) thread = std::max(thread, added[other]);
        added[group] = thread;
    }
    return turns.size() / *std::max_element(free.begin(), free.end());
}

/// A sheet of 200 elements has work for eight threads, whatever its colours.
void check_that_threads_are_fed() {
    for (const int side : {14, 15, 25, 40}) {
        const Connectivity part = grid(side, side, 5);
        const Turns turns(part, make_colours_of_groups(part, 4), 4);
        CHECK(faster(turns, 2) > 1.93);
        CHECK(faster(turns, 8) > 7.0);
        CHECK(faster(turns, 16) > 12.0);
    }
}

/// The first exception comes out, and nobody waits for ever for a group that has thrown; the next round is as ever.
void check_exceptions() {
    Turns turns = turns_of(grid(9, 8, 5), 4);
    for (const int failing : {0, turns.size() / 2, turns.size() - 1}) {
        const auto work = [&](int group, int, const auto& turn) {
            if (group == failing) throw std::runtime_error("thrown");
            turn();
        };
        CHECK(throws<std::runtime_error>([&] { turns.run(3, work); }));
    }
    std::atomic<int> count{0};
    turns.run(3, [&](int, int, const auto& turn) { turn(), ++count; });
    CHECK(count == turns.size());
}

/// A team has as many threads as it was given, whatever is set while it works: there are no more workspaces.
void check_team() {
    Turns turns = turns_of(grid(30, 30, 5), 1);
    const int before = thread_count();
    std::atomic<int> largest{0};
    thread_count() = 1;
    turns.run(2, [&](int, int thread, const auto&) {
        thread_count() = 7;
        for (int seen = largest; thread > seen && !largest.compare_exchange_weak(seen, thread);) {
        }
    });
    CHECK(largest <= 1);
    thread_count() = before;
}

}  // namespace

int main() {
    check_groups();
    check_order();
    check_group_that_adds_nothing();
    check_that_threads_are_fed();
    check_exceptions();
    check_team();
    return report("turns");
}
