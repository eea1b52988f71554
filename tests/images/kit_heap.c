/* SPDX-License-Identifier: MIT
 * The heap's end: what asks for more than there is gets a null pointer, and the C library still has what it needs. */
#include <malloc.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(void) {
  volatile size_t half = 1U << 16U, most = SIZE_MAX - 15; /* GCC must not know */
  const int refused = !calloc(half, half) + !calloc(half + 1, half + 1) + !malloc(most) + !realloc(NULL, most) +
                      !reallocarray(NULL, half, half) + !memalign(64, most) + !aligned_alloc(64, most);
  char* const zeros = calloc(100, 7);
  char* const aligned = aligned_alloc(256, 1000);
  int good = zeros != NULL && (uintptr_t)aligned % 256 == 0;
  for (int i = 0; good && i < 700; ++i) good = zeros[i] == 0;
  char* const kept = malloc(5);
  strcpy(kept, "kept");
  unsigned blocks = 0;
  while (malloc(1000)) ++blocks;
  while (malloc(1)) continue;
  /* From here on nothing of the C library has been used before. */
  printf("%d refused, good %d, %s, many %d, %.3g\n", refused, good, kept, blocks > 500, 1e300);
  char digits[400];
  printf("%d digits, %s\n", snprintf(digits, sizeof digits, "%.60f", 1e300), realloc(kept, most) ? "more" : "no more");
  fprintf(stderr, "%g\n", strtod("6.02e23", NULL));
  return 0;
}
