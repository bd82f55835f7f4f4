// Batches: elements of one group that are worked on together, one in each lane.
#pragma once

#include <algorithm>
#include <array>

#include "umform/algebra/lanes.hpp"
#include "umform/assembly/turns.hpp"

namespace umform {

/// Elements of the lanes; the last of `count` fills the remaining lanes, whose results are discarded.
struct Batch {
    std::array<std::int32_t, lane_count> element;
    int count;

    LaneMask filled() const {
        LaneMask mask = false;
        for (int lane = 0; lane < count; ++lane) mask.set(lane, true);
        return mask;
    }
};

/// A batch of each group.
inline std::vector<Batch> make_batches(const Turns& turns) {
    std::vector<Batch> batches;
    for (int group = 0; group < turns.size(); ++group) {
        const auto elements = turns.elements(group);
        const int count = static_cast<int>(elements.size());
        Batch batch{{}, count};
        for (int lane = 0; lane < lane_count; ++lane) batch.element[lane] = elements[std::min(lane, count - 1)];
        batches.push_back(batch);
    }
    return batches;
}

/// Reads a nodal field into the lanes as mean and half difference of the faces, each by direction. eq. (2.34)
template <int Nodes>
void gather(const Connectivity& part, const Batch& batch, const double* field, std::array<Lanes, 3 * Nodes>& local) {
    constexpr int face = Nodes / 2, half = 3 * face;
    for (int a = 0; a < face; ++a)
        for (int k = 0; k < 3; ++k) {
            Lanes lower, upper;
            for (int lane = 0; lane < lane_count; ++lane) {
                const std::int32_t* ids = part[batch.element[lane]];
                lower.set(lane, field[3 * ids[a] + k]);
                upper.set(lane, field[3 * ids[a + face] + k]);
            }
            local[k * face + a] = 0.5 * (upper + lower);
            local[half + k * face + a] = 0.5 * (upper - lower);
        }
}

/// Matrices and forces of the elements in the lanes by node: i = direction * Nodes + node, K on and above its diagonal, or all
/// of it where it is not symmetric.
template <int Nodes>
struct NodalResults {
    static constexpr int face = Nodes / 2, half = 3 * face, size = 2 * half;
    std::array<std::array<double, static_cast<std::size_t>(size) * size>, lane_count> K;
    std::array<std::array<double, size>, lane_count> f;

    /// From mean m and director d of both faces: lower = m - d, upper = m + d.
    void set_forces(const Lanes* forces) {
        for (int i = 0; i < half; ++i) {
            store_force(lower(i), 0.5 * (forces[i] - forces[half + i]));
            store_force(lower(i) + face, 0.5 * (forces[i] + forces[half + i]));
        }
    }

    /// An entry of the faces with the signs s_i and s_j is (mm + s_i dm + s_j dm^T + s_i s_j dd) / 4. eq. (2.38)
    void set_tangent(const Lanes* Kmm, const Lanes* Kdm, const Lanes* Kdd) {
        for (int i = 0; i < half; ++i)
            for (int j = i; j < half; ++j) {
                const Lanes mm = 0.25 * Kmm[i * half + j], dd = 0.25 * Kdd[i * half + j];
                const Lanes dm = 0.25 * Kdm[i * half + j], md = 0.25 * Kdm[j * half + i];
                const Lanes same = mm + dd, across = mm - dd, sum = dm + md, difference = dm - md;
                store(lower(i), lower(j), same - sum);
                store(lower(i) + face, lower(j) + face, same + sum);
                store(lower(i), lower(j) + face, across - difference);
                const bool above = i / face < j / face;
                store(above ? lower(i) + face : lower(j), above ? lower(j) : lower(i) + face, across + difference);
            }
    }

    /// All entries, of a matrix that is not symmetric: (mm + s_i dm + s_j md + s_i s_j dd) / 4.
    void set_tangent_full(const Lanes* Kmm, const Lanes* Kdm, const Lanes* Kmd, const Lanes* Kdd) {
        for (int i = 0; i < half; ++i)
            for (int j = 0; j < half; ++j) {
                const int at = i * half + j;
                for (const int row : {0, 1})
                    for (const int column : {0, 1}) {
                        const double si = row == 0 ? -1.0 : 1.0, sj = column == 0 ? -1.0 : 1.0;
                        store(lower(i) + row * face, lower(j) + column * face,
                              0.25 * (Kmm[at] + si * Kdm[at] + sj * Kmd[at] + si * sj * Kdd[at]));
                    }
            }
    }

  private:
    static int lower(int i) { return i / face * Nodes + i % face; }
    void store(int i, int j, Lanes value) {
        for (int lane = 0; lane < lane_count; ++lane) K[lane][i * size + j] = value[lane];
    }
    void store_force(int i, Lanes value) {
        for (int lane = 0; lane < lane_count; ++lane) f[lane][i] = value[lane];
    }
};

}  // namespace umform
