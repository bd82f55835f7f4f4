// Contact points of a facet: areas, and how far they move at most.
#include <random>

#include "check.hpp"
#include "umform/contact/facet.hpp"

using namespace umform;

namespace {

/// A rectangle of 2 x 3, its nodes in the order of topology.hpp.
template <int Nodes>
std::vector<double> rectangle() {
    constexpr std::array<std::array<int, 2>, 9> place{
        {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}}};
    std::vector<double> X;
    for (int a = 0; a < Nodes; ++a) X.insert(X.end(), {1.0 * place[a][0], 1.5 * place[a][1], 0.3});
    return X;
}

template <int Nodes>
Connectivity one() {
    Connectivity part{Nodes, {}};
    for (int a = 0; a < Nodes; ++a) part.ids.push_back(a);
    return part;
}

/// The areas of the points add up to that of the facet, and no random motion of the nodes moves a point farther than it may.
template <int Nodes>
void check(ContactRule rule) {
    const FacetPoints<Nodes> facet(one<Nodes>(), rectangle<Nodes>(), rule);
    CHECK(facet.count() == (rule.at_nodes ? Nodes : rule.points[0] * rule.points[1]));
    double total = 0.0;
    for (const double area : facet.area) total += area;
    CHECK_NEAR(total, 6.0, 1e-14);
    const double largest = facet.largest_motion();
    CHECK(largest >= 1.0 && largest <= (Nodes == 4 ? 1.0 + 1e-15 : 1.5625));
    std::mt19937 random(1);
    double farthest = 0.0;
    for (int trial = 0; trial < 20000; ++trial) {
        std::array<double, Nodes> way;
        for (double& value : way) value = random() % 2 == 0 ? -1.0 : 1.0;
        for (const auto& N : facet.N) {
            double sum = 0.0;
            for (int a = 0; a < Nodes; ++a) sum += N[a] * way[a];
            farthest = std::max(farthest, std::abs(sum));
        }
    }
    CHECK(farthest <= largest + 1e-14 && farthest > 0.99 * largest);
}

}  // namespace

int main() {
    for (const int points : {1, 2, 3, 7}) {
        check<4>({{points, points}, false});
        check<9>({{points, points}, false});
    }
    check<9>({{5, 2}, false});
    check<4>({{1, 1}, true});
    check<9>({{1, 1}, true});
    const FacetPoints<9> fine(one<9>(), rectangle<9>(), {{3, 3}, false});
    CHECK(fine.largest_motion() > 1.2);  // the quadratic functions have two signs
    return report("contact facet");
}
