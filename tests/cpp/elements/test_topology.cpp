// Shape functions: partition of unity, value one at their own node, slopes against differences, reproduction of fields.
#include "check.hpp"
#include "umform/elements/topology.hpp"

using namespace umform;

namespace {

constexpr std::array<double, 9> node_r{-1, 1, 1, -1, 0, 1, 0, -1, 0}, node_s{-1, -1, 1, 1, -1, 0, 1, 0, 0};
constexpr std::array<double, 5> samples{-1.0, -0.57, 0.0, 0.31, 1.0};

template <int Nodes>
void face() {
    for (int a = 0; a < Nodes; ++a) {
        const auto at_node = face_shape<Nodes>(node_r[a], node_s[a]);
        for (int b = 0; b < Nodes; ++b) CHECK_NEAR(at_node.N[b], a == b ? 1.0 : 0.0, 1e-15);
    }
    for (const double r : samples)
        for (const double s : samples) {
            const auto shape = face_shape<Nodes>(r, s);
            double N = 0, Nr = 0, Ns = 0, x = 0, xr = 0, xs = 0;
            for (int a = 0; a < Nodes; ++a) {
                // The highest monomial that the face must reproduce: r s, or r^2 s^2.
                const double field = Nodes == 4 ? node_r[a] * node_s[a] : std::pow(node_r[a] * node_s[a], 2);
                N += shape.N[a], Nr += shape.Nr[a], Ns += shape.Ns[a];
                x += shape.N[a] * field, xr += shape.Nr[a] * field, xs += shape.Ns[a] * field;
            }
            CHECK_NEAR(N, 1.0, 1e-15);
            CHECK_NEAR(Nr, 0.0, 1e-15);
            CHECK_NEAR(Ns, 0.0, 1e-15);
            CHECK_NEAR(x, Nodes == 4 ? r * s : r * r * s * s, 1e-15);
            CHECK_NEAR(xr, Nodes == 4 ? s : 2 * r * s * s, 1e-15);
            CHECK_NEAR(xs, Nodes == 4 ? r : 2 * r * r * s, 1e-15);
        }
}

template <int Nodes>
void shell() {
    constexpr int half = Nodes / 2;
    const double h = 1e-6;
    for (int a = 0; a < Nodes; ++a) {
        const auto at_node = shell_shape<Nodes>(node_r[a % half], node_s[a % half], a < half ? -1.0 : 1.0);
        for (int b = 0; b < Nodes; ++b) CHECK_NEAR(at_node[b], a == b ? 1.0 : 0.0, 1e-15);
    }
    for (const double r : samples)
        for (const double s : samples)
            for (const double t : samples) {
                const auto N = shell_shape<Nodes>(r, s, t);
                const auto dN = shell_gradient<Nodes>(r, s, t);
                const auto r1 = shell_shape<Nodes>(r + h, s, t), r0 = shell_shape<Nodes>(r - h, s, t);
                const auto s1 = shell_shape<Nodes>(r, s + h, t), s0 = shell_shape<Nodes>(r, s - h, t);
                const auto t1 = shell_shape<Nodes>(r, s, t + h), t0 = shell_shape<Nodes>(r, s, t - h);
                double sum = 0.0;
                std::array<double, 3> slope{};
                for (int a = 0; a < Nodes; ++a) {
                    sum += N[a];
                    for (int i = 0; i < 3; ++i) slope[i] += dN[i][a];
                    CHECK_NEAR(dN[0][a], (r1[a] - r0[a]) / (2 * h), 1e-9);
                    CHECK_NEAR(dN[1][a], (s1[a] - s0[a]) / (2 * h), 1e-9);
                    CHECK_NEAR(dN[2][a], (t1[a] - t0[a]) / (2 * h), 1e-9);
                }
                CHECK_NEAR(sum, 1.0, 1e-15);
                for (const double value : slope) CHECK_NEAR(value, 0.0, 1e-15);
            }
}

}  // namespace

int main() {
    face<4>();
    face<9>();
    shell<8>();
    shell<18>();
    return report("topology");
}
