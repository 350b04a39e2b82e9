#pragma once

// Defines POESY_ADDRESS_SANITIZER or POESY_THREAD_SANITIZER if this build has that sanitizer, and POESY_SANITIZED if it
// has either of them. Compilers state this in different macros.
#if defined(__SANITIZE_ADDRESS__)
#define POESY_ADDRESS_SANITIZER
#endif
#if defined(__SANITIZE_THREAD__)
#define POESY_THREAD_SANITIZER
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define POESY_ADDRESS_SANITIZER
#endif
#if __has_feature(thread_sanitizer)
#define POESY_THREAD_SANITIZER
#endif
#endif
#if defined(POESY_ADDRESS_SANITIZER) || defined(POESY_THREAD_SANITIZER)
#define POESY_SANITIZED
#endif
