// Matrices of nodes that change from one evaluation to the next, added where the pattern has them.
#pragma once

#include <vector>

#include "umform/assembly/pattern.hpp"
#include "umform/assembly/target.hpp"

namespace umform {

/// Forces at some nodes, 3 * node + direction, and their derivatives with respect to more nodes, by rows; a node may occur more than
/// once.
struct LoosePart {
    std::vector<std::int32_t> nodes, others;  // of the forces, of the derivatives
    std::vector<double> K, f;

    int rows() const { return 3 * static_cast<int>(nodes.size()); }
    int columns() const { return 3 * static_cast<int>(others.size()); }
    double* row(int i) { return K.data() + static_cast<std::size_t>(i) * columns(); }
    const double* row(int i) const { return K.data() + static_cast<std::size_t>(i) * columns(); }

    void start(bool tangent) {
        f.assign(rows(), 0.0);
        if (tangent) K.assign(static_cast<std::size_t>(rows()) * columns(), 0.0);
    }

    /// Adds it; throws std::out_of_range where no term has declared a coupling.
    void add(const Pattern& pattern, const Target& target) const {
        for (int i = 0; i < rows(); ++i) target.f[dof(nodes, i)] += f[i];
        if (target.du != nullptr)
            for (int i = 0; i < rows(); ++i) {
                double sum = 0.0;
                for (int j = 0; j < columns(); ++j) sum += row(i)[j] * target.du[dof(others, j)];
                target.Kdu[dof(nodes, i)] += sum;
            }
        if (target.values == nullptr) return;
        for (int i = 0; i < rows(); ++i) {
            const std::int32_t equation = pattern.equation[dof(nodes, i)];
            if (equation < 0) continue;
            for (std::size_t b = 0; b < others.size(); ++b)
                add_node(pattern, equation, others[b], row(i) + 3 * b, target.values);
        }
    }

  private:
    static std::size_t dof(const std::vector<std::int32_t>& ids, int i) {
        return 3 * static_cast<std::size_t>(ids[i / 3]) + i % 3;
    }

    /// Entries of a row at the three directions of a node, which follow each other where all are free.
    static void add_node(const Pattern& pattern, std::int32_t row, std::int32_t node, const double* entries,
                         double* values) {
        const std::int32_t* column = pattern.equation.data() + 3 * static_cast<std::ptrdiff_t>(node);
        std::int32_t before = -2, place = -1;
        for (int l = 0; l < 3; ++l) {
            if (column[l] < 0 || entries[l] == 0.0 || (pattern.symmetric && column[l] < row)) continue;
            place = column[l] == before + 1 ? place + 1 : pattern.find(row, column[l]);
            before = column[l];
            values[place] += entries[l];
        }
    }
};

}  // namespace umform
