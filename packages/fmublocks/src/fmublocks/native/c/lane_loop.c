/* The steps of a whole loop in lanes: what the master of the harness does with single instances. */

/* What is done in a step, in lane_loop.py: values are copied, a function of a block is called, or an input is set to
move along a line. */
typedef struct {
    void (*call)(void *block, double duration); /* NULL: none */
    void *block;
    size_t count;        /* of copies */
    const lanes **from;  /* of a line: the source at the end of the step or NULL; its rates at both ends or NULL */
    lanes **to;          /* of a line: the input and its rate */
    int is_line;
} Action;

/* A column of the results, and its place in their rows. */
typedef struct {
    size_t offset;
    int is_whole; /* an int32_t */
} Column;

/* The results of a car. */
typedef struct {
    unsigned char *rows;
    size_t count;
} Table;

/* The line of input_lines.py. */
static void aim(const Action *line, double h)
{
    const lanes *end = line->from[0], *before = line->from[1], *after = line->from[2];
    lanes *input = line->to[0], *rate = line->to[1];
    if (!end) {
        *rate = *before;
        return;
    }
    const lanes way = *end - *input;
    if (!before || !after) {
        *rate = way / h;
        return;
    }
    *rate = (1.2 * way - 0.1 * h * (*before + *after)) / h;
    *input = *input + 0.5 * way + h * (*before - *after) / 12.0 - 0.5 * h * *rate;
}

static void act(const Action *action, double h)
{
    if (action->is_line) {
        aim(action, h);
        return;
    }
    for (size_t k = 0; k < action->count; k++)
        *action->to[k] = *action->from[k];
    if (action->call)
        action->call(action->block, h);
}

/* The values of columns at an instant; a run that has ended keeps its last ones. */
static void read_columns(
    const Column columns[], size_t count, const Table tables[WIDTH], size_t size, size_t instant, lanes row[])
{
    EACH_LANE(lane) {
        const Table *table = &tables[lane];
        const unsigned char *at = table->rows + size * (instant < table->count ? instant : table->count - 1);
        for (size_t k = 0; k < count; k++) {
            const void *place = at + columns[k].offset;
            row[k][lane] = columns[k].is_whole ? (double)*(const int32_t *)place : *(const double *)place;
        }
    }
}

static void write_columns(
    const Column columns[], size_t count, const Table tables[WIDTH], size_t size, size_t instant, const lanes row[])
{
    unsigned char *at[WIDTH];
    EACH_LANE(lane) at[lane] = tables[lane].rows + size * instant;
    for (size_t k = 0; k < count; k++) {
        const size_t offset = columns[k].offset;
        const lanes values = row[k];
        EACH_LANE(lane) if (instant < tables[lane].count) {
            if (columns[k].is_whole)
                *(int32_t *)(void *)(at[lane] + offset) = (int32_t)values[lane];
            else
                *(double *)(void *)(at[lane] + offset) = values[lane];
        }
    }
}

/* Makes the steps that begin with the rows first ... last - 1. The first `known` columns are known of all instants.
Time goes on to the next instant before action number `turn`. */
EXPORT void lanes_run(
    const Action actions[], size_t turn, size_t number, double step_size, const Column columns[], size_t known,
    size_t count, lanes row[], const Table tables[WIDTH], size_t size, size_t first, size_t last)
{
    if (first == 0)
        read_columns(columns, count, tables, size, 0, row);
    for (size_t k = first; k < last; k++) {
        for (size_t n = 0; n < turn; n++)
            act(&actions[n], step_size);
        read_columns(columns, known, tables, size, k + 1, row);
        for (size_t n = turn; n < number; n++)
            act(&actions[n], step_size);
        write_columns(columns + known, count - known, tables, size, k + 1, row + known);
    }
}
