// The contact points of a facet: Gauss points, or its nodes.
#pragma once

#include <cmath>

#include "umform/algebra/tensor.hpp"
#include "umform/assembly/connectivity.hpp"
#include "umform/elements/quadrature.hpp"
#include "umform/elements/topology.hpp"

namespace umform {

/// Where a facet is checked: at Gauss points, with their numbers along r and s, or at its nodes with tributary areas.
struct ContactRule {
    SurfacePoints points{2, 2};
    bool at_nodes = false;
};

/// Largest displacement of a point if no node moves by more than one: the largest sum of |N|.
template <int Nodes>
double largest_motion(const std::vector<std::array<double, Nodes>>& N) {
    double largest = 1.0;
    for (const auto& values : N) {
        double sum = 0.0;
        for (const double value : values) sum += std::abs(value);
        largest = std::max(largest, sum);
    }
    return largest;
}

/// Reference area of a facet over that of the square of r and s. eq. (4.8)
template <int Nodes>
double face_jacobian(const std::int32_t* ids, const std::vector<double>& X, double r, double s) {
    const FaceShape<Nodes> shape = face_shape<Nodes>(r, s);
    Vec3 Gr{}, Gs{};
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) {
            Gr[k] += shape.Nr[a] * X[3 * ids[a] + k];
            Gs[k] += shape.Ns[a] * X[3 * ids[a] + k];
        }
    const Vec3 normal = cross(Gr, Gs);
    return std::sqrt(dot(normal, normal));
}

/// Shape functions at the points of a facet, and the reference areas of the points of all facets.
template <int Nodes>
struct FacetPoints {
    using Values = std::array<double, Nodes>;

    std::vector<Values> N;     // [point]
    std::vector<double> area;  // [facet][point]

    FacetPoints(const Connectivity& part, const std::vector<double>& X, ContactRule rule) {
        if (rule.at_nodes)
            nodal(part, X);
        else
            gaussian(part, X, gauss(rule.points));
    }

    int count() const { return static_cast<int>(N.size()); }
    int places() const { return count(); }

    double largest_motion() const { return umform::largest_motion<Nodes>(N); }

  private:
    void gaussian(const Connectivity& part, const std::vector<double>& X, const SurfaceRule& rule) {
        const auto& [along_r, along_s] = rule;
        for (const double s : along_s.x)
            for (const double r : along_r.x) N.push_back(face_shape<Nodes>(r, s).N);
        for (int e = 0; e < part.size(); ++e)
            for (int is = 0; is < along_s.size(); ++is)
                for (int ir = 0; ir < along_r.size(); ++ir)
                    area.push_back(along_r.w[ir] * along_s.w[is]
                                   * face_jacobian<Nodes>(part[e], X, along_r.x[ir], along_s.x[is]));
    }

    /// Tributary areas int N_a dA: 1/4 of a plane 4-node facet, 1/36, 4/36 and 16/36 of a plane 9-node facet. eq. (4.12)
    void nodal(const Connectivity& part, const std::vector<double>& X) {
        for (int a = 0; a < Nodes; ++a) {
            Values values{};
            values[a] = 1.0;
            N.push_back(values);
        }
        const Rule rule = gauss(4);
        for (int e = 0; e < part.size(); ++e) {
            Values tributary{};
            for (int is = 0; is < rule.size(); ++is)
                for (int ir = 0; ir < rule.size(); ++ir) {
                    const double dA =
                        rule.w[ir] * rule.w[is] * face_jacobian<Nodes>(part[e], X, rule.x[ir], rule.x[is]);
                    const Values values = face_shape<Nodes>(rule.x[ir], rule.x[is]).N;
                    for (int a = 0; a < Nodes; ++a) tributary[a] += values[a] * dA;
                }
            area.insert(area.end(), tributary.begin(), tributary.end());
        }
    }
};

}  // namespace umform
