// Normals of a face that do not jump at the edges of its facets: those at the nodes are means, and the facets interpolate them.
#pragma once

#include <algorithm>
#include <vector>

#include "umform/assembly/connectivity.hpp"
#include "umform/assembly/threads.hpp"
#include "umform/contact/sheets/facet_at.hpp"

namespace umform {

/// Unit normals at the nodes of some facets: the direction of the sum of the unit normals of the facets there. eq. (4.302)
template <int Nodes>
class NodalNormals {
  public:
    explicit NodalNormals(const Connectivity& part) : part_(part) {
        ids_ = part_.ids;
        std::sort(ids_.begin(), ids_.end());
        ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
        at_.resize(ids_.size()), ring_.resize(ids_.size()), local_.resize(part_.size());
        for (int m = 0; m < part_.size(); ++m)
            for (int a = 0; a < Nodes; ++a) {
                const int node =
                    static_cast<int>(std::lower_bound(ids_.begin(), ids_.end(), part_[m][a]) - ids_.begin());
                local_[m][a] = node, at_[node].push_back({m, a});
                ring_[node].insert(ring_[node].end(), part_[m], part_[m] + Nodes);
            }
        for (auto& ring : ring_) sort_unique(ring);
        around_.resize(part_.size());
        for (int m = 0; m < part_.size(); ++m) {
            std::vector<std::int32_t> rest;
            for (const int node : local_[m]) rest.insert(rest.end(), ring_[node].begin(), ring_[node].end());
            sort_unique(rest);
            around_[m].assign(part_[m], part_[m] + Nodes);
            for (const std::int32_t id : rest)
                if (std::find(part_[m], part_[m] + Nodes, id) == part_[m] + Nodes) around_[m].push_back(id);
        }
        normals_.resize(ids_.size()), slopes_.resize(ids_.size());
    }

    /// Nodes that the normals of a facet depend on: its own ones, then the others.
    const std::vector<std::int32_t>& around(int facet) const { return around_[facet]; }

    /// Normals at positions x [node of the model], and their derivatives if requested.
    void update(const std::vector<Vec3>& x, bool slopes, int threads) {
        for_each_range(static_cast<int>(ids_.size()), threads, [&](int first, int last) {
            for (int node = first; node < last; ++node) at_node(node, x, slopes);
        });
    }

    std::array<Vec3, Nodes> of(int facet) const {
        std::array<Vec3, Nodes> normals;
        for (int a = 0; a < Nodes; ++a) normals[a] = normals_[local_[facet][a]];
        return normals;
    }

    /// Derivatives of sum N_a nu_a of a facet with respect to the nodes `around` it.
    void slope(int facet, const std::array<double, Nodes>& N, std::vector<Mat3>& by) const {
        const auto& around = around_[facet];
        by.assign(around.size(), Mat3{});
        for (int a = 0; a < Nodes; ++a) {
            const int node = local_[facet][a];
            for (std::size_t i = 0; i < ring_[node].size(); ++i) {
                const auto b = std::find(around.begin(), around.end(), ring_[node][i]) - around.begin();
                for (int k = 0; k < 9; ++k) by[b].a[k] += N[a] * slopes_[node][i].a[k];
            }
        }
    }

  private:
    struct Corner {
        int facet, node;
    };

    static void sort_unique(std::vector<std::int32_t>& ids) {
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    }

    void at_node(int node, const std::vector<Vec3>& x, bool slopes) {
        Vec3 sum{};
        std::vector<Mat3>& by = slopes_[node];
        if (slopes) by.assign(ring_[node].size(), Mat3{});
        for (const Corner& corner : at_[node]) {
            const std::int32_t* ids = part_[corner.facet];
            const FaceShape<Nodes> shape = corners()[corner.node];
            Vec3 g1{}, g2{};
            for (int b = 0; b < Nodes; ++b)
                for (int k = 0; k < 3; ++k) {
                    g1[k] += shape.Nr[b] * x[ids[b]][k];
                    g2[k] += shape.Ns[b] * x[ids[b]][k];
                }
            const Vec3 c = cross(g1, g2);
            const double length = std::sqrt(dot(c, c));
            const Vec3 n{c[0] / length, c[1] / length, c[2] / length};
            for (int k = 0; k < 3; ++k) sum[k] += n[k];
            for (int b = 0; slopes && b < Nodes; ++b) {
                const auto& ring = ring_[node];
                const auto at = std::lower_bound(ring.begin(), ring.end(), ids[b]) - ring.begin();
                for (int j = 0; j < 3; ++j) {
                    Vec3 e{};
                    e[j] = 1.0;
                    const Vec3 one = cross(e, g2), other = cross(g1, e);
                    Vec3 dc;
                    for (int k = 0; k < 3; ++k) dc[k] = shape.Nr[b] * one[k] + shape.Ns[b] * other[k];
                    const double along = dot(n, dc);
                    for (int k = 0; k < 3; ++k) by[at](k, j) += (dc[k] - along * n[k]) / length;
                }
            }
        }
        const double length = std::sqrt(dot(sum, sum));
        for (int k = 0; k < 3; ++k) normals_[node][k] = sum[k] / length;
        for (Mat3& slope : by) slope = across(slope, normals_[node], length);
    }

    static const std::array<FaceShape<Nodes>, Nodes>& corners() {
        static const std::array<FaceShape<Nodes>, Nodes> shapes = [] {
            constexpr std::array<double, 9> r{-1, 1, 1, -1, 0, 1, 0, -1, 0}, s{-1, -1, 1, 1, -1, 0, 1, 0, 0};
            std::array<FaceShape<Nodes>, Nodes> all;
            for (int a = 0; a < Nodes; ++a) all[a] = face_shape<Nodes>(r[a], s[a]);
            return all;
        }();
        return shapes;
    }

    Connectivity part_;
    std::vector<std::int32_t> ids_;                  // [local node]
    std::vector<std::array<int, Nodes>> local_;      // [facet]
    std::vector<std::vector<Corner>> at_;            // [local node]
    std::vector<std::vector<std::int32_t>> ring_;    // [local node] of the facets there, sorted
    std::vector<std::vector<std::int32_t>> around_;  // [facet]
    std::vector<Vec3> normals_;                      // [local node]
    std::vector<std::vector<Mat3>> slopes_;          // [local node][of its ring]
};

}  // namespace umform
