// CRC-64/XZ: finds every burst of up to 64 damaged bits, and any other damage but for one case in 1.8e19.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ogive::io {

// CRC of `size` bytes. To continue over several pieces, pass the CRC of what came before.
std::uint64_t crc64(const void* data, std::size_t size, std::uint64_t before = 0);

}  // namespace ogive::io
