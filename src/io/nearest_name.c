#include "io/nearest_name.h"

#include <stddef.h>
#include <string.h>

#define MAX_LETTERS 63

static int smaller(int a, int b) { return a < b ? a : b; }

static int num_letters(const char *text)
{
    const size_t length = strlen(text);
    return length > MAX_LETTERS ? MAX_LETTERS : (int)length;
}

int scree_name_distance(const char *a, const char *b)
{
    const int num_a = num_letters(a), num_b = num_letters(b);
    int rows[3][MAX_LETTERS + 1]; // distances of the beginnings: two rows back, one row back, this row
    int *before = rows[0], *last = rows[1], *row = rows[2];
    for (int j = 0; j <= num_b; ++j) row[j] = before[j] = j;
    for (int i = 1; i <= num_a; ++i)
    {
        int *free_row = before;
        before = last;
        last = row;
        row = free_row;
        row[0] = i;
        for (int j = 1; j <= num_b; ++j)
        {
            row[j] = smaller(last[j], row[j - 1]) + 1;
            row[j] = smaller(row[j], last[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = smaller(row[j], before[j - 2] + 1);
        }
    }
    return row[num_b];
}

int scree_name_is_near(const char *name, const char *known)
{
    const int longest = num_letters(name) > num_letters(known) ? num_letters(name) : num_letters(known);
    // the beginning of a known name, or the name with more behind it, is meant more often than not
    const size_t common = strlen(name) < strlen(known) ? strlen(name) : strlen(known);
    if (common >= 3 && strncmp(name, known, common) == 0) return 1;
    return scree_name_distance(name, known) <= smaller(longest / 3, 4) + (longest >= 2 && longest < 3);
}

const char *scree_nearest_name(const char *name, const char *const *known, int num)
{
    const char *nearest = NULL;
    for (int k = 0; k < num; ++k)
    {
        if (!scree_name_is_near(name, known[k])) continue;
        if (nearest == NULL || scree_name_distance(name, known[k]) < scree_name_distance(name, nearest))
            nearest = known[k];
    }
    return nearest;
}
