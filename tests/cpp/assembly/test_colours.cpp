// Elements of a colour share no node.
#include <set>

#include "assembly/grid.hpp"
#include "check.hpp"
#include "umform/assembly/colours.hpp"

using namespace umform;

namespace {

void check_that_none_share_a_node(const Connectivity& part, const Colours& colours) {
    std::set<std::int32_t> seen;
    for (const auto& colour : colours) {
        std::set<std::int32_t> nodes;
        for (const std::int32_t e : colour) {
            CHECK(seen.insert(e).second);
            for (int a = 0; a < part.nodes; ++a) CHECK(nodes.insert(part[e][a]).second);
        }
    }
    CHECK(static_cast<int>(seen.size()) == part.size());
}

void check_groups() {
    for (const auto& [n, m] : {std::pair{1, 1}, {7, 1}, {9, 8}, {19, 2}, {30, 20}}) {
        const Connectivity part = grid(n, m, 5);
        const Colours colours = make_colours_of_groups(part, 4);
        check_that_none_share_a_node(part, colours);
        CHECK(groups_of(colours, 4) <= groups_of(make_colours(part), 4));
    }
    CHECK(groups_of(make_colours(grid(19, 2, 5)), 4) == 12);
    CHECK(groups_of(make_colours_of_groups(grid(19, 2, 5), 4), 4) == 10);  // as few as 38 elements can take
    CHECK(make_colours(grid(9, 8, 5), 3).empty());
    CHECK(make_colours_of_groups(Connectivity{4, {}}, 4).empty());
}

void check_colours() {
    for (const auto& [n, m] : {std::pair{1, 1}, {7, 1}, {9, 8}}) {
        const Connectivity part = grid(n, m, 5);
        const auto colours = make_colours(part);
        check_that_none_share_a_node(part, colours);
        CHECK(colours.size() <= 9);
    }
    CHECK(make_colours(Connectivity{4, {}}).empty());
    Connectivity fan{4, {}};  // 64 quadrilaterals around node 0
    for (int e = 0; e < 64; ++e)
        for (const int node : {0, 3 * e + 1, 3 * e + 2, 3 * e + 3}) fan.ids.push_back(node);
    CHECK(throws<std::invalid_argument>([&] { make_colours(fan); }));
}

}  // namespace

int main() {
    check_colours();
    check_groups();
    return report("colours");
}
