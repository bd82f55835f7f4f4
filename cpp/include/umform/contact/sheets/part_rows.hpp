// Rows of the tangent of a point: sums over nodes, and over the nodes that a normal depends on.
#pragma once

#include <vector>

#include "umform/assembly/loose_part.hpp"
#include "umform/contact/sheets/foot.hpp"

namespace umform {

/// Where the nodes of a facet, or of a cut edge of it, begin among those of the forces and of the derivatives.
struct Slot {
    std::int32_t facet;
    int row, column;
    std::int32_t rim = -1;
};

/// A vector that is a sum over nodes of one or two facets.
template <int Nodes>
struct NodeSum {
    using Values = std::array<double, Nodes>;
    int count = 0;
    std::array<Slot, 2> at{};
    std::array<Values, 2> by{};
    void add(const Slot& slot, const Values& values, double sign) {
        at[count] = slot;
        for (int a = 0; a < Nodes; ++a) by[count][a] = sign * values[a];
        ++count;
    }
};

/// The change of the interpolated normal at fixed coordinates: a matrix for each node around a facet. eq. (4.304)
struct Turn {
    Slot at{};
    std::vector<Mat3> by;
};

/// Rows over the columns of a part.
template <int Nodes>
struct PartRows {
    using Sum = NodeSum<Nodes>;
    int columns;
    std::vector<double> values;

    PartRows(int count, int columns) : columns(columns), values(static_cast<std::size_t>(count) * columns, 0.0) {}
    double* row(int i) { return values.data() + static_cast<std::size_t>(i) * columns; }

    /// Of a factor times a sum over nodes.
    void add(const Mat3& block, const Sum& sum) {
        for (int k = 0; k < sum.count; ++k)
            for (int b = 0; b < Nodes; ++b)
                for (int i = 0; i < 3; ++i)
                    for (int l = 0; l < 3; ++l) row(i)[3 * (sum.at[k].column + b) + l] += sum.by[k][b] * block(i, l);
    }
    void add(const Mat3& block, const Turn& turn) {
        for (std::size_t b = 0; b < turn.by.size(); ++b) {
            const Mat3 all = product(block, turn.by[b]);
            for (int i = 0; i < 3; ++i)
                for (int l = 0; l < 3; ++l) row(i)[3 * (turn.at.column + b) + l] += all(i, l);
        }
    }
    /// A factor times the change of the gap, in the first row.
    void add_gap(double factor, const FootMoves<Nodes>& moves, const Sum& d, const Turn& turn) {
        for (int k = 0; k < d.count; ++k)
            for (int b = 0; b < Nodes; ++b)
                for (int l = 0; l < 3; ++l)
                    row(0)[3 * (d.at[k].column + b) + l] += factor * d.by[k][b] * moves.gap[0][l];
        for (std::size_t b = 0; b < turn.by.size(); ++b)
            for (int l = 0; l < 3; ++l) {
                double sum = 0.0;
                for (int i = 0; i < 3; ++i) sum += moves.gap[1][i] * turn.by[b](i, l);
                row(0)[3 * (turn.at.column + b) + l] += factor * sum;
            }
    }
    /// Adds three rows, those of a force, to the rows of the nodes that it acts on.
    void spread(const Sum& sum, LoosePart& part) {
        for (int k = 0; k < sum.count; ++k)
            for (int a = 0; a < Nodes; ++a)
                for (int i = 0; i < 3; ++i) {
                    double* into = part.row(3 * (sum.at[k].row + a) + i);
                    for (int j = 0; j < columns; ++j) into[j] += sum.by[k][a] * row(i)[j];
                }
    }
};

}  // namespace umform
