// Any tool at another place: turned, shifted, or mirrored.
#pragma once

#include <vector>

#include "umform/surfaces/concept.hpp"

namespace umform {

class Placed final : public Surface {
  public:
    /// A point X of the tool goes to Q X + c; Q is orthogonal, a rotation or a reflection.
    Placed(std::shared_ptr<const Surface> tool, const Mat3& Q, const Vec3& c) : tool_(std::move(tool)), Q_(Q), c_(c) {}

    bool is_distance() const override { return tool_->is_distance(); }
    double above() const override { return tool_->above(); }
    bool is_concurrent() const override { return tool_->is_concurrent(); }

    bool searches() const override { return tool_->searches(); }

    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        tool_->gap(count, to_tool(count, x).data(), g, n, H);
        to_space(count, n, H);
    }
    void gap_again(int count, const double* x, Nearby* nearby, double* g, double* n, double* H) const override {
        tool_->gap_again(count, to_tool(count, x).data(), nearby, g, n, H);
        to_space(count, n, H);
    }

  private:
    /// The tool is evaluated once for all points. Not inlined, so that both ways have the same bits.
    [[gnu::noinline]] std::vector<double> to_tool(int count, const double* x) const {
        std::vector<double> local(3 * static_cast<std::size_t>(count));
        for (int q = 0; q < count; ++q)
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) local[3 * q + k] += Q_(i, k) * (x[3 * q + i] - c_[i]);
        return local;
    }

    /// g = g_local, n = Q n_local, H = Q H_local Q^T. eq. (4.18)
    [[gnu::noinline]] void to_space(int count, double* n, double* H) const {
        for (int q = 0; q < count; ++q) {
            turn(n + 3 * q);
            turn_both_sides(H + 9 * q);
        }
    }

    void turn(double* a) const {
        const Vec3 old{a[0], a[1], a[2]};
        for (int i = 0; i < 3; ++i) a[i] = Q_(i, 0) * old[0] + Q_(i, 1) * old[1] + Q_(i, 2) * old[2];
    }

    void turn_both_sides(double* H) const {
        for (int row = 0; row < 3; ++row) turn(H + 3 * row);  // H Q^T
        for (int j = 0; j < 3; ++j) {
            double column[3] = {H[j], H[3 + j], H[6 + j]};
            turn(column);
            for (int i = 0; i < 3; ++i) H[3 * i + j] = column[i];
        }
    }

    std::shared_ptr<const Surface> tool_;
    Mat3 Q_;
    Vec3 c_;
};

}  // namespace umform
