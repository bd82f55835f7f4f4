// How the update of a front is stored: what is left of it for the front of the parent.
#pragma once

#include <cstddef>

namespace umform {

/// Places of the columns of an update. Of a symmetric one the lower triangle is stored, by blocks of columns that begin at the
/// diagonal of their first one, so that a block is a matrix for BLAS; columns that could not be eliminated come before.
struct UpdateLayout {
    std::size_t order = 0, left = 0;  // rows; columns that could not be eliminated
    std::size_t width = 0;            // columns of a block; 0 where all rows of all columns are stored

    UpdateLayout() = default;
    UpdateLayout(std::size_t all, std::size_t not_eliminated, bool symmetric)
        : order(all), left(not_eliminated), width(symmetric ? block_of(all - not_eliminated) : 0) {}

    std::size_t size() const {
        if (width == 0) return order * order;
        const std::size_t beyond = order - left, blocks = (beyond + width - 1) / width;
        if (blocks == 0) return left * order;
        const std::size_t last = beyond - (blocks - 1) * width;
        return left * order + full_blocks(blocks - 1) + last * last;
    }
    /// Where row 0 of a column would lie; stored rows begin at the diagonal at the latest.
    std::size_t column(std::size_t j) const {
        if (width == 0 || j < left) return j * order;
        const std::size_t block = (j - left) / width, first = block * width;
        return left * order + full_blocks(block) + (j - left - first) * (order - left - first) - left - first;
    }
    /// From a column to the next one of its block.
    std::size_t stride(std::size_t j) const {
        return width == 0 || j < left ? order : order - left - (j - left) / width * width;
    }
    /// Few columns are best in small updates, for what a block has above the diagonal is wasted. They depend on the update alone,
    /// so that its bits do.
    static std::size_t block_of(std::size_t beyond) { return beyond < 400 ? 48 : 96; }

  private:
    std::size_t full_blocks(std::size_t count) const {
        return count == 0 ? 0 : width * (count * (order - left) - width * (count * (count - 1) / 2));
    }
};

}  // namespace umform
