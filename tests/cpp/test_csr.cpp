// Pattern, scatter map and colours on a grid of quadrilaterals with prescribed degrees of freedom.
#include <random>
#include <set>

#include "check.hpp"
#include "umform/assembly/csr.hpp"

using namespace umform;

namespace {

/// n x m quadrilaterals with their node ids shuffled.
Connectivity grid(int n, int m, unsigned seed) {
    std::vector<std::int32_t> number((n + 1) * (m + 1));
    for (std::size_t k = 0; k < number.size(); ++k) number[k] = static_cast<std::int32_t>(k);
    std::shuffle(number.begin(), number.end(), std::mt19937(seed));
    Connectivity part{4, {}};
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                part.ids.push_back(number[(i + di) * (m + 1) + j + dj]);
    return part;
}

/// Equation numbers with every fifth degree of freedom prescribed.
std::vector<std::int32_t> equations(int nodes) {
    std::vector<std::int32_t> equation(3 * nodes);
    std::int32_t next = 0;
    for (int dof = 0; dof < 3 * nodes; ++dof) equation[dof] = dof % 5 == 2 ? -1 : next++;
    return equation;
}

void check_pattern(bool symmetric) {
    const Connectivity part = grid(5, 4, 3), other = grid(2, 2, 9);  // two kinds of elements on shared nodes
    const Pattern pattern = make_pattern(equations(30), {&part, &other}, symmetric);
    std::set<std::pair<int, int>> expected;
    for (int row = 0; row < pattern.rows(); ++row) expected.insert({row, row});
    for (int dof = 0; dof < 90; ++dof)  // the three directions of a node are always coupled
        for (int k = 0; k < 3; ++k) {
            const int i = pattern.equation[dof], j = pattern.equation[dof / 3 * 3 + k];
            if (i >= 0 && j >= (symmetric ? i : 0)) expected.insert({i, j});
        }
    for (const Connectivity* kind : {&part, &other})
        for (int e = 0; e < kind->size(); ++e)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b)
                    for (int k = 0; k < 3; ++k)
                        for (int l = 0; l < 3; ++l) {
                            const int i = pattern.equation[3 * (*kind)[e][a] + k],
                                      j = pattern.equation[3 * (*kind)[e][b] + l];
                            if (i >= 0 && j >= (symmetric ? i : 0)) expected.insert({i, j});
                        }
    std::set<std::pair<int, int>> found;
    for (int row = 0; row < pattern.rows(); ++row)
        for (auto at = pattern.indptr[row]; at < pattern.indptr[row + 1]; ++at) {
            found.insert({row, pattern.indices[at]});
            CHECK(at == pattern.indptr[row] || pattern.indices[at] > pattern.indices[at - 1]);
            CHECK(pattern.find(row, pattern.indices[at]) == at);
        }
    CHECK(found == expected);
    CHECK(pattern.indices.size() == expected.size());
}

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

void check_colours() {
    for (const auto& [n, m] : {std::pair{1, 1}, {7, 1}, {9, 8}}) {
        const Connectivity part = grid(n, m, 5);
        const auto colours = make_colours(part);
        std::set<std::int32_t> seen;
        for (const auto& colour : colours) {
            std::set<std::int32_t> nodes;
            for (const std::int32_t e : colour) {
                CHECK(seen.insert(e).second);
                for (int a = 0; a < part.nodes; ++a) CHECK(nodes.insert(part[e][a]).second);
            }
        }
        CHECK(static_cast<int>(seen.size()) == part.size());
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
    for (const bool symmetric : {true, false}) {
        check_pattern(symmetric);
        check_scatter(symmetric);
    }
    check_colours();
    return report("csr");
}
