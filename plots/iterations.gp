# SPDX-License-Identifier: GPL-3.0-or-later
# The curves of earlier iterations behind a result, light to dark: of each table NAME.tsv those in
# NAME_history.tsv, if it is there: x, then one column an iteration. Loaded by the scripts that draw them.

history = table[1:strlen(table) - 4] . "_history.tsv"

# Number of columns, and of the first and last iteration, from the header. Of many iterations
# every n-th is drawn: more than `most_lines` cannot be told apart.
most_lines = 16
columns = 1
if (has(history)) {
    found = system("awk -F '\t' '/^#/ { count = split($0, name, FS) } END { \
        gsub(/\\[.*|[^0-9]/, \"\", name[2]); gsub(/\\[.*|[^0-9]/, \"\", name[count]); \
        print count, name[2] + 0, name[count] + 0 }'" . from(history))
    columns = int(word(found, 1))
    first = real(word(found, 2))
    last = columns > 2 ? real(word(found, 3)) : first + 1
}
# The only iteration there is, is the result.
if (columns == 2) { columns = 1 }
every = high(1, ceil((columns - 1) / real(most_lines)))
iteration_of(column) = first + (last - first) * (column - 2.0) / high(1, columns - 2)
oldest = 2 + (columns - 2) % every

# Without a history there is no bar.
unset colorbox

# Commands for the colours of iterations and the bar that explains them, whose left lower corner is at
# x, y of the panel.
iteration_bar(x, y) = "set palette defined (0 '#d9e0e6', 1 '#41749c'); set cbrange [first:last]; " . \
    sprintf("set colorbox horizontal user origin graph %g, graph %g size graph 0.2, graph 0.02 noborder; ", x, y) . \
    "set cbtics (first, last) scale 0 offset 0, 0.5; " . \
    sprintf("set label 2 'iteration' at graph %g, graph %g center", x + 0.1, y + 0.045)
