/* SPDX-License-Identifier: MIT
 * Files of the host, standard input, and memory until there is none; each PE says what it found. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <torolux.h>
#include <unistd.h>

static void expect_error(const char* name, const char* mode, int error) {
  errno = 0;
  FILE* file = fopen(name, mode);
  if (file != NULL || errno != error) torolux_fail("fopen should have failed otherwise");
}

static void expect_bad_number(long result) {
  if (result != -1 || errno != EBADF) torolux_fail("a file that is not open for this should be refused");
  errno = 0;
}

static void use_wrong_numbers(void) {
  char byte = 'x';
  const int input = open("data", O_RDONLY);
  expect_bad_number(write(input, &byte, 1));
  expect_bad_number(read(input + 1, &byte, 1));
  close(input);
  expect_bad_number(read(input, &byte, 1));
  expect_bad_number(close(input));
  const int output = open("log", O_WRONLY | O_APPEND);
  expect_bad_number(read(output, &byte, 1));
  close(output);
}

/* Lines of `data` are numbers: their sum, by lines, and once more by bytes from the middle. */
static long sum_of_lines(void) {
  FILE* in = fopen("data", "r");
  if (in == NULL) torolux_fail("data cannot be opened");
  long sum = 0;
  char line[64];
  while (fgets(line, sizeof line, in) != NULL) sum += strtol(line, NULL, 10);
  if (fseek(in, 0, SEEK_END) != 0) torolux_fail("fseek");
  const long bytes = ftell(in);
  if (fseek(in, bytes / 2, SEEK_SET) != 0 || ftell(in) != bytes / 2) torolux_fail("fseek to the middle");
  long rest = 0;
  while (getc(in) != EOF) ++rest;
  if (rest != bytes - bytes / 2) torolux_fail("bytes behind the middle");
  fclose(in);
  return sum;
}

int main(int argc, char** argv) {
  const unsigned pe = torolux_pe();
  expect_error("nobody gave this", "r", ENOENT);
  expect_error("data", "w", EACCES);
  expect_error("table", "r", EACCES);
  use_wrong_numbers();
  const long sum = sum_of_lines();
  /* A row of the table each, at a place of its own. */
  FILE* table = fopen("table", "w");
  fseek(table, (long)pe * 16, SEEK_SET);
  fprintf(table, "%6u %8ld\n", pe, sum);
  fclose(table);
  /* In the order of virtual time: made the order of the PEs by a token. */
  if (pe != 0) torolux_receive((int)pe - 1, NULL, 0);
  FILE* log = fopen("log", "a");
  fprintf(log, "PE %u was here\n", pe);
  fclose(log);
  const char word[] = "raw ";
  torolux_send(TOROLUX_HOST, word, 4);
  torolux_send((int)((pe + 1) % torolux_pes()), NULL, 0);
  if (pe == 0) torolux_receive((int)torolux_pes() - 1, NULL, 0);
  char first[32] = "nothing";
  if (pe == 0 && scanf("%31s", first) != 1) strcpy(first, "end of file");
  size_t blocks = 0;
  while (malloc(4096) != NULL) ++blocks;
  fprintf(stderr, "PE %u: %d arguments, stdin %s\n", pe, argc - 1, first);
  printf("half a line, ");
  printf("%s, %d, %g, %s\n", argc > 1 ? argv[1] : "-", blocks > 16, 0.1,
         clock() > 0 && time(NULL) == 0 ? "early" : "late");
  printf("no end");
  return argc > 2 && pe % 2 == 1 ? atoi(argv[2]) + (int)pe : 0;
}
