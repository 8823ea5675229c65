/* huge_page_pool.cpp - see huge_page_pool.h. */
#include "host/runtime/interface/huge_page_pool.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <sys/mman.h>

namespace tandem {
namespace {

constexpr size_t bytes_of_piece = size_t{16} << 20;

} // namespace

HugePagePool::~HugePagePool()
{
  for (const Piece &piece : pieces_) std::free(piece.memory);
}

/* The first that is large enough; the number of blocks if there is none. */
size_t HugePagePool::free_block(const Piece &piece, size_t bytes)
{
  const auto fits = [&](const Block &block) { return !block.used && block.bytes >= bytes; };
  return static_cast<size_t>(std::find_if(piece.blocks.begin(), piece.blocks.end(), fits) - piece.blocks.begin());
}

void *HugePagePool::take(Piece &piece, size_t number, size_t bytes)
{
  const Block whole = piece.blocks[number];
  if (whole.bytes > bytes) /* before anything changes, because it may find no memory */
    piece.blocks.insert(piece.blocks.begin() + static_cast<std::ptrdiff_t>(number) + 1,
                        {whole.offset + bytes, whole.bytes - bytes, false});
  piece.blocks[number] = {whole.offset, bytes, true};
  return piece.memory + whole.offset;
}

HugePagePool::Piece &HugePagePool::add_piece()
{
  std::vector<Block> blocks{{0, bytes_of_piece, false}};
  pieces_.reserve(pieces_.size() + 1);
  auto *memory = static_cast<char *>(std::aligned_alloc(huge_page, bytes_of_piece));
  if (!memory) throw std::bad_alloc();
  madvise(memory, bytes_of_piece, MADV_HUGEPAGE); /* advice; ignoring it costs only time */
  return pieces_.emplace_back(Piece{memory, std::move(blocks)});
}

void *HugePagePool::allocate(size_t bytes)
{
  const size_t rounded = (bytes + small_page - 1) / small_page * small_page;
  const std::lock_guard guard(mutex_);
  for (Piece &piece : pieces_) {
    const size_t block = free_block(piece, rounded);
    if (block < piece.blocks.size()) return take(piece, block, rounded);
  }
  return take(add_piece(), 0, rounded);
}

bool HugePagePool::release(void *memory) noexcept
{
  const std::lock_guard guard(mutex_);
  const auto *const at = static_cast<const char *>(memory);
  const auto piece = std::find_if(pieces_.begin(), pieces_.end(), [&](const Piece &one) {
    return at >= one.memory && at < one.memory + bytes_of_piece;
  });
  if (piece == pieces_.end()) return false;
  std::vector<Block> &blocks = piece->blocks;
  auto block =
      std::find_if(blocks.begin(), blocks.end(), [&](const Block &one) { return piece->memory + one.offset == at; });
  block->used = false;
  if (block + 1 != blocks.end() && !(block + 1)->used) {
    block->bytes += (block + 1)->bytes;
    blocks.erase(block + 1);
  }
  if (block != blocks.begin() && !(block - 1)->used) {
    (block - 1)->bytes += block->bytes;
    blocks.erase(block);
  }
  if (blocks.size() > 1 || blocks.front().used) return true;
  std::free(piece->memory);
  pieces_.erase(piece);
  return true;
}

} // namespace tandem
