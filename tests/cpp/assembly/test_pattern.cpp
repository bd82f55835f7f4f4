// The sparse pattern of two kinds of elements with prescribed degrees of freedom.
#include <set>

#include "assembly/grid.hpp"
#include "check.hpp"
#include "umform/assembly/pattern.hpp"

using namespace umform;

namespace {

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

/// A pair that no element couples is refused with its row and column, and never its neighbour's entry.
void check_missing(bool symmetric) {
    const Connectivity part{4, {0, 1, 2, 3, 2, 3, 4, 5}};  // nodes 0 and 1 share no element with 4 and 5
    std::vector<std::int32_t> equation(18);
    for (int dof = 0; dof < 18; ++dof) equation[dof] = dof;
    const Pattern pattern = make_pattern(equation, {&part}, symmetric);
    CHECK(pattern.find(0, 11) == 11);
    for (const auto& [row, column] : {std::pair{0, 12}, {5, 17}, {0, 18}, {0, -1}, {-1, 0}, {18, 18}})
        CHECK(throws<std::out_of_range>([&, row = row, column = column] { (void)pattern.find(row, column); }));
    if (symmetric) CHECK(throws<std::out_of_range>([&] { (void)pattern.find(3, 2); }));  // below the diagonal
    try {
        (void)pattern.find(0, 12);
    } catch (const std::out_of_range& error) {
        const std::string text = error.what();
        CHECK(text.find("row 0") != std::string::npos && text.find("column 12") != std::string::npos);
    }
}

/// A term of its own may couple any nodes: a spring between the ends of the row above, or one node with the ground.
void check_couplings() {
    const Connectivity part{4, {0, 1, 2, 3, 2, 3, 4, 5}}, spring{2, {0, 5}}, ground{1, {4}};
    std::vector<std::int32_t> equation(18);
    for (int dof = 0; dof < 18; ++dof) equation[dof] = dof;
    const Pattern bare = make_pattern(equation, {&part}, true);
    const Pattern coupled = make_pattern(equation, {&part, &spring, &ground}, true);
    CHECK(coupled.indices.size() == bare.indices.size() + 9);
    CHECK(coupled.indices[coupled.find(0, 17)] == 17);
    const Connectivity beyond{2, {0, 6}};
    CHECK(throws<std::out_of_range>([&] { make_pattern(equation, {&part, &beyond}, true); }));
    const Pattern none = make_pattern(std::vector<std::int32_t>(18, -1), {&part}, true);
    CHECK(none.rows() == 0);
}

}  // namespace

int main() {
    for (const bool symmetric : {true, false}) {
        check_pattern(symmetric);
        check_missing(symmetric);
    }
    check_couplings();
    return report("pattern");
}
