#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <takt/record/output_file.hpp>

namespace takt::record {

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_{path}, file_{std::fopen(path.c_str(), "wb")} {
    if (file_ == nullptr) {
        throw std::runtime_error{"cannot write " + path.string() + ": " +
                                 std::system_category().message(errno)};
    }
    std::setvbuf(file_, nullptr, _IOFBF, std::size_t{1} << 18);
}

OutputFile::~OutputFile() {
    std::fclose(file_);
}

void OutputFile::write(std::string_view text) noexcept {
    const std::size_t written = std::fwrite(text.data(), 1, text.size(), file_);
    dropped_ += text.size() - written;
}

void OutputFile::write(std::span<const std::uint8_t> bytes) noexcept {
    const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), file_);
    dropped_ += bytes.size() - written;
}

bool OutputFile::flush() noexcept {
    if (std::fflush(file_) != 0) failed_ = true;
    return ok();
}

}  // namespace takt::record
