#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace pyroscene {

/// Who has to act: the user whose input was refused (exit code 3), or the run that failed (exit code 1).
enum class ErrorKind { Input, Runtime };

/// The one exception type of the program: where it happened, about what, and what to do.
/// what() reads "subject: message"; the subject is a file, a scenario key or a band.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, std::string_view subject, std::string_view message)
        : std::runtime_error(subject.empty() ? std::string(message) : std::string(subject).append(": ").append(message)),
          kind_(kind) {}

    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

private:
    ErrorKind kind_;
};

/// Something the user supplied cannot be used (file, line or band; found; expected).
inline Error input_error(std::string_view subject, std::string_view message) { return {ErrorKind::Input, subject, message}; }
/// The run could not go on (disk full, file vanished, library failure).
inline Error runtime_error(std::string_view subject, std::string_view message) {
    return {ErrorKind::Runtime, subject, message};
}

/// Thrown when the user interrupts; the CLI turns it into exit code 1 with one line.
class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error("interrupted") {}
};

}  // namespace pyroscene
