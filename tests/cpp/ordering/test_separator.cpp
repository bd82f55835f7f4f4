// The fewest vertices that part two sides of a graph, against all subsets of the vertices.
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "check.hpp"
#include "umform/ordering/separator.hpp"

using namespace umform::ordering;

namespace {

/// A random graph between two sides, and its neighbours as sets of bits.
struct Drawn {
    Between graph;
    std::vector<std::uint32_t> near;
    std::uint32_t first = 0, last = 0;

    Drawn(std::mt19937& random, int size) : near(size, 0) {
        const unsigned edges = 1 + random() % 4;  // of ten
        for (int v = 0; v < size; ++v)
            for (int w = 0; w < v; ++w)
                if (random() % 10 < edges) near[v] |= 1U << w, near[w] |= 1U << v;
        for (int v = 0; v < size; ++v) {
            first |= static_cast<std::uint32_t>(random() % 3 == 0) << v;
            last |= static_cast<std::uint32_t>(random() % 3 == 0) << v;
            for (int w = 0; w < size; ++w)
                if ((near[v] >> w & 1U) != 0) graph.to.push_back(w);
            graph.start.push_back(static_cast<int>(graph.to.size()));
            graph.at_first.push_back(first >> v & 1U), graph.at_last.push_back(last >> v & 1U);
        }
    }

    /// What can be reached from some vertices without those that are cut out.
    std::uint32_t reached(std::uint32_t from, std::uint32_t cut) const {
        std::uint32_t found = from & ~cut;
        for (std::uint32_t before = 0; before != found;) {
            before = found;
            for (std::size_t v = 0; v < near.size(); ++v)
                if ((before >> v & 1U) != 0) found |= near[v] & ~cut;
        }
        return found;
    }

    /// Size of the smallest set of vertices that parts the sides.
    int fewest() const {
        int least = static_cast<int>(near.size());
        for (std::uint32_t cut = 0; cut < 1U << near.size(); ++cut)
            if (std::popcount(cut) < least && (reached(first, cut) & last) == 0) least = std::popcount(cut);
        return least;
    }
};

void check_separators() {
    std::mt19937 random(1);
    std::vector<std::int8_t> side;
    for (int k = 0; k < 300; ++k) {
        Drawn drawn(random, 2 + static_cast<int>(random() % 9));
        const int least = drawn.fewest(), size = static_cast<int>(drawn.near.size());
        CHECK(drawn.graph.part(0, size + 1, side) == least);
        std::uint32_t parts[3] = {0, 0, 0};  // first side, separator, last side
        for (int v = 0; v < size; ++v) parts[side[v] + 1] |= 1U << v;
        CHECK(std::popcount(parts[1]) == least);
        CHECK((parts[0] & drawn.last) == 0 && (parts[2] & drawn.first) == 0);
        for (int v = 0; v < size; ++v)
            if (side[v] < 0) CHECK((drawn.near[v] & parts[2]) == 0);
        CHECK(drawn.graph.part(0, least, side) >= least);  // not fewer than the limit
    }
}

/// Of the two separators nearest to the sides, the one that leaves them more equal.
void check_balance() {
    Between path;  // 0 - 1 - 2 - 3 - 4
    for (int v = 0; v < 5; ++v) {
        if (v > 0) path.to.push_back(v - 1);
        if (v < 4) path.to.push_back(v + 1);
        path.start.push_back(static_cast<int>(path.to.size()));
        path.at_first.push_back(v == 0), path.at_last.push_back(v == 4);
    }
    std::vector<std::int8_t> side;
    CHECK(path.part(10, 6, side) == 1 && side == std::vector<std::int8_t>({0, 1, 1, 1, 1}));
    CHECK(path.part(-10, 6, side) == 1 && side == std::vector<std::int8_t>({-1, -1, -1, -1, 0}));
}

}  // namespace

int main() {
    check_separators();
    check_balance();
    return report("separators");
}
