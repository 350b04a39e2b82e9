#pragma once

// Defines macros that say which sanitizers this build has, because each compiler has its own macros:
// POESY_ADDRESS_SANITIZER, POESY_THREAD_SANITIZER, and POESY_SANITIZED if it has either.
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
