// A tool that another one gives: grown by a thickness, or all that lies beyond a sheet of this thickness on it.
#pragma once

#include "umform/surfaces/concept.hpp"

namespace umform {

class Offset final : public Surface {
  public:
    /// side 1: the tool grown by `distance`; side -1: what is farther from it than that.
    Offset(std::shared_ptr<const Surface> tool, double distance, int side)
        : tool_(std::move(tool)), distance_(distance), side_(side) {}

    bool is_distance() const override { return tool_->is_distance(); }
    double above() const override { return tool_->above(); }
    bool is_concurrent() const override { return tool_->is_concurrent(); }

    bool searches() const override { return tool_->searches(); }

    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        tool_->gap(count, x, g, n, H);
        shift(count, g, n, H);
    }
    void gap_again(int count, const double* x, Nearby* nearby, double* g, double* n, double* H) const override {
        tool_->gap_again(count, x, nearby, g, n, H);
        shift(count, g, n, H);
    }

  private:
    /// g = s (g - d), n = s n, H = s H. eq. (4.172)
    void shift(int count, double* g, double* n, double* H) const {
        for (int q = 0; q < count; ++q) g[q] = side_ * (g[q] - distance_);
        if (side_ > 0) return;
        for (int i = 0; i < 3 * count; ++i) n[i] = -n[i];
        for (int i = 0; i < 9 * count; ++i) H[i] = -H[i];
    }

    std::shared_ptr<const Surface> tool_;
    double distance_;
    int side_;
};

}  // namespace umform
