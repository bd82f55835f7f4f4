// A facet on a sphere: shifted gap, force and tangent with multipliers, and the penalty as their special case.
#include <numeric>
#include <random>

#include "check.hpp"
#include "umform/contact/facets.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

const std::vector<double> X{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// One facet of unit area on a sphere of radius 5 whose top is 0.01 above its middle.
std::unique_ptr<ContactBlock> facet() {
    auto tool = std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.5, 0.5, -4.99}, 5.0, false});
    auto block = std::make_unique<ContactBlockOf<4>>(Connectivity{4, {0, 1, 2, 3}}, X, ContactRule{2, false}, tool);
    block->penalty = 50.0;
    return block;
}

struct Answer {
    std::vector<double> f = std::vector<double>(12), K = std::vector<double>(144);
};

Answer evaluate(ContactBlock& block, const std::vector<double>& u) {
    std::vector<std::int32_t> equation(12);
    std::iota(equation.begin(), equation.end(), 0);
    const Pattern pattern = make_pattern(equation, {&block.connectivity()}, false);
    const Scatter scatter = make_scatter(pattern, block.connectivity());
    Answer answer;
    block.evaluate(u.data(), scatter, {answer.f.data(), answer.K.data()});
    return answer;
}

std::vector<double> waved() {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0.0, 0.01);
    std::vector<double> u(12);
    for (double& value : u) value = normal(random);
    return u;
}

void check_tangent() {
    const auto block = facet();
    const std::vector<double> u = waved(), multipliers{3.0, 0.0, 1.5, 0.2};
    block->set_multipliers(multipliers.data());
    const Answer at = evaluate(*block, u);
    const double h = 1e-7;
    for (int j = 0; j < 12; ++j) {
        std::vector<double> ahead = u, behind = u;
        ahead[j] += h, behind[j] -= h;
        const Answer plus = evaluate(*block, ahead), minus = evaluate(*block, behind);
        for (int i = 0; i < 12; ++i) CHECK_NEAR(at.K[12 * i + j], (plus.f[i] - minus.f[i]) / (2 * h), 1e-5);
    }
}

/// The resultant of the nodal forces is that of the pressures <lambda - penalty g> at the points.
void check_resultant() {
    const auto block = facet();
    const std::vector<double> u = waved(), multipliers{3.0, 0.0, 1.5, 0.2};
    block->set_multipliers(multipliers.data());
    const Answer at = evaluate(*block, u);
    for (int k = 0; k < 3; ++k) {
        double nodes = 0.0, points = 0.0;
        for (int a = 0; a < 4; ++a) nodes += at.f[3 * a + k];
        for (int q = 0; q < block->points(); ++q) {
            const double pressure = std::max(multipliers[q] - 50.0 * block->gaps()[q], 0.0);
            points -= pressure * block->areas()[q] * block->normals()[3 * q + k];
        }
        CHECK_NEAR(nodes, points, 1e-14);
    }
}

/// A multiplier holds a point at an open gap up to multiplier / penalty = 0.02, and no further.
void check_open_gap() {
    const auto block = facet();
    const std::vector<double> none(4, 0.0), multipliers(4, 1.0);
    for (const double lift : {0.005, 0.05}) {
        std::vector<double> u(12);
        for (int a = 0; a < 4; ++a) u[3 * a + 2] = lift;
        block->set_multipliers(none.data());
        CHECK_NEAR(evaluate(*block, u).f[2], 0.0, 0.0);
        CHECK(block->gaps()[0] > 0.0);
        block->set_multipliers(multipliers.data());
        CHECK((evaluate(*block, u).f[2] < 0.0) == (block->gaps()[0] < 0.02));
        CHECK((block->gaps()[0] < 0.02) == (lift < 0.01));
    }
}

}  // namespace

int main() {
    check_tangent();
    check_resultant();
    check_open_gap();
    return report("contact");
}
