/* huge_page_pool.h - buffers that are smaller than some huge pages, side by side in one piece of such pages.
 *
 *   piece, 16 MiB   | buffer | buffer    | free | buffer |              free               |
 *
 * A scene of thousands of bodies has a hundred buffers of some hundred kilobytes, of which kernels read a little here
 * and a little there. With small pages a step of 64,000 boxes took 6 % longer on one thread, and one of 2,048 robots
 * 8 %. A huge page for each of them would take several times their memory.
 */
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

namespace tandem {

constexpr size_t small_page = 4096, huge_page = size_t{2} << 20;

class HugePagePool {
public:
  /* Both in bytes. Larger buffers have huge pages of their own; smaller ones are few. */
  static constexpr size_t least = size_t{64} << 10, most = 2 * huge_page;

  HugePagePool() = default;
  HugePagePool(const HugePagePool &) = delete;
  HugePagePool &operator=(const HugePagePool &) = delete;
  ~HugePagePool();

  /* From a small page on; whatever it held before. Throws std::bad_alloc, and has changed nothing then. */
  void *allocate(size_t bytes);
  /* Returns false of what is not of this pool. */
  bool release(void *memory) noexcept;

private:
  /* Blocks of a piece follow each other without gaps; no two free ones do. */
  struct Block {
    size_t offset, bytes;
    bool used;
  };
  struct Piece {
    char *memory;
    std::vector<Block> blocks;
  };
  static size_t free_block(const Piece &piece, size_t bytes);
  static void *take(Piece &piece, size_t block, size_t bytes);
  Piece &add_piece();

  std::mutex mutex_;
  std::vector<Piece> pieces_;
};

} // namespace tandem
