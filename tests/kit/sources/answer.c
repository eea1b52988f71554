/* SPDX-License-Identifier: MIT
 * A number that a compiler cannot know: nothing enters, one digit leaves. */
static volatile unsigned many = 1000;

int answer(void) {
  unsigned sum = 1;
  for (unsigned i = 0; i < many; ++i) sum = sum * 31 + i % 7;
  return (int)(sum % 10);
}
