// Element matrices on their way into a pattern.
#include "assembly/grid.hpp"
#include "check.hpp"
#include "umform/assembly/target.hpp"

using namespace umform;

namespace {

/// Element matrices that go through the scatter map give the same sums as a dense assembly.
void check_scatter(bool symmetric) {
    const Connectivity part = grid(5, 4, 3);
    const Pattern pattern = make_pattern(equations(30), {&part}, symmetric);
    const Scatter scatter = make_scatter(pattern, part);
    const int size = 12, rows = pattern.rows();
    CHECK(scatter.size == size);
    std::vector<double> values(pattern.indices.size()), dense(static_cast<std::size_t>(rows) * rows), K(size * size);
    std::mt19937 generator(1);
    for (int e = 0; e < part.size(); ++e) {
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j) {
                K[i * size + j] = static_cast<double>(generator() % 1000);
                if (symmetric && j < i) K[i * size + j] = K[j * size + i];
            }
        scatter.add(e, K.data(), values.data());
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j) {
                const int row = pattern.equation[3 * part[e][i % 4] + i / 4];
                const int column = pattern.equation[3 * part[e][j % 4] + j / 4];
                if (row >= 0 && column >= 0) dense[static_cast<std::size_t>(row) * rows + column] += K[i * size + j];
            }
    }
    double total = 0.0;
    for (int row = 0; row < rows; ++row)
        for (auto at = pattern.indptr[row]; at < pattern.indptr[row + 1]; ++at) {
            const double expected = dense[static_cast<std::size_t>(row) * rows + pattern.indices[at]];
            CHECK_NEAR(values[at], expected, 0.0);
            total += (symmetric && pattern.indices[at] != row ? 2.0 : 1.0) * values[at];
        }
    double whole = 0.0;
    for (const double value : dense) whole += value;
    CHECK_NEAR(total, whole, 0.0);  // nothing lies outside of the pattern
}

/// Elements that the pattern does not know are refused instead of added to their neighbours.
void check_unknown() {
    const Connectivity part{4, {0, 1, 2, 3, 2, 3, 4, 5}}, other{2, {0, 5}}, beyond{2, {0, 6}};
    std::vector<std::int32_t> equation(18);
    for (int dof = 0; dof < 18; ++dof) equation[dof] = dof;
    for (const bool symmetric : {true, false}) {
        const Pattern pattern = make_pattern(equation, {&part}, symmetric);
        CHECK(throws<std::out_of_range>([&] { make_scatter(pattern, other); }));
        CHECK(throws<std::out_of_range>([&] { make_scatter(pattern, beyond); }));
    }
}

/// A full matrix and one given by its upper triangle, with and without the product K du.
void check_element(bool full) {
    const Connectivity part{4, {3, 0, 1, 2}};
    std::vector<std::int32_t> equation(12);
    for (int dof = 0; dof < 12; ++dof) equation[dof] = dof;
    const Pattern pattern = make_pattern(equation, {&part}, false);
    const Scatter scatter = make_scatter(pattern, part);
    std::mt19937 generator(2);
    std::array<double, 12> forces{}, du{};
    std::array<double, 144> given{};
    for (double& value : given) value = static_cast<double>(generator() % 100);
    for (double& value : du) value = static_cast<double>(generator() % 100);
    std::vector<double> dense(144), product(12);
    const auto global = [&](int i) { return 3 * part[0][i % 4] + i / 4; };
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            const double value = full || j >= i ? given[12 * i + j] : given[12 * j + i];
            dense[12 * global(i) + global(j)] = value;
            product[global(i)] += value * du[global(j)];
        }
    std::vector<double> f(12), values(pattern.indices.size()), Kdu(12);
    std::array<double, 144> K = given;
    scatter_element<4>(part, scatter, 0, K.data(), forces.data(), {f.data(), values.data(), du.data(), Kdu.data()},
                       full);
    for (int i = 0; i < 12; ++i) {
        CHECK_NEAR(Kdu[i], product[i], 0.0);
        for (int j = 0; j < 12; ++j) CHECK_NEAR(values[pattern.find(i, j)], dense[12 * i + j], 0.0);
    }
}

/// A pattern of one triangle refuses a tangent that is not symmetric, by the name of its term.
void check_refusal() {
    Scatter scatter;
    scatter.symmetric = true;
    try {
        scatter.require(false, "contact punch");
        CHECK(false);
    } catch (const std::invalid_argument& error) {
        CHECK(std::string(error.what()).find("contact punch") != std::string::npos);
    }
    scatter.require(true, "contact punch");
    scatter.symmetric = false;
    scatter.require(false, "contact punch");
}

}  // namespace

int main() {
    for (const bool flag : {true, false}) {
        check_scatter(flag);
        check_element(flag);
    }
    check_unknown();
    check_refusal();
    return report("scatter");
}
