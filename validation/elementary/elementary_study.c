// Single spheres for the study of elementary cases: each line of the output is one JSON object. See README.md.
#include "chung_ooi_solids.h"

static void put_row(const char *test, const char *name, const char *quantity, double expected, double got,
                    const char *from)
{
    printf(
        "{\"part\": \"table\", \"test\": \"%s\", \"case\": \"%s\", \"quantity\": \"%s\", \"expected\": %.9g, \"got\": "
        "%.9g, \"from\": \"%s\"}\n",
        test, name, quantity, expected, got, from);
}

/// Elastic impacts with a hundred steps in contact, against what was published.
static void put_elastic(const char *test, const char *name, impact_def def, const double published[3])
{
    def.time_step = hertz_contact_time(&def) / 100;
    const impact_result r = impact_run(&def);
    put_row(test, name, "d_max [m]", published[0], r.deepest, "published");
    put_row(test, name, "F_max [N]", published[1], r.largest_force, "published");
    put_row(test, name, "t_c [s]", published[2], r.contact_time, "published");
}

static void tests_1_to_3(void)
{
    const solid solids[6] = {glass, limestone, al_alloy, mg_alloy, al_oxide, cast_iron};
    const double published[6][3] = {{274.1e-6, 10.697e3, 40.34e-6}, {368.3e-6, 7.108e3, 54.20e-6},
                                    {49.72e-6, 11.370e3, 731.7e-6}, {52.12e-6, 7.233e3, 767.1e-6},
                                    {8.089e-6, 615.4, 6.105e-6},    {17.19e-6, 506.8, 12.97e-6}};
    const double radius[3] = {0.01, 0.1, 0.0025}, speed[3] = {10, 0.2, 3.9};
    const char *tests[3] = {"1", "2", "3"};
    for (int k = 0; k < 6; ++k)
    {
        impact_def def = define(solids[k], radius[k / 2], speed[k / 2]);
        if (k < 2) def.body[1] = (impact_body){radius[0], {0, 0, speed[0]}, {0}};
        put_elastic(tests[k / 2], solids[k].name, def, published[k]);
        if (k < 4) continue;
        for (int n = 1; n <= 5; ++n)
        {
            def.restitution = 0.2 * n;
            def.time_step = hertz_contact_time(&def) / 4000;
            put_row("3", solids[k].name, "e", def.restitution, impact_run(&def).velocity[0][2] / 3.9, "given");
        }
    }
}

/// Speed and spin of the upper sphere after an impact that slides throughout, for the numbers' own restitution e.
static void put_sliding(const char *test, const char *name, const impact_def *def, const impact_result *r)
{
    const double pushed = r->velocity[0][2] - def->body[0].velocity[2];
    const double v =
        def->body[0].velocity[0] - (def->body[0].spin[1] * def->body[0].radius > 0 ? -1 : 1) * def->friction * pushed;
    const double spin = def->body[0].spin[1] + 2.5 * def->friction * pushed / def->body[0].radius;
    put_row(test, name, "v_t' [m/s]", v, r->velocity[0][0], "closed form");
    put_row(test, name, "spin' [rad/s]", spin, r->spin[0][1], "closed form");
}

static void put_oblique(const char *part, const char *name, double x, const impact_def *def, const impact_result *r)
{
    const double radius = def->body[0].radius, v_n = r->velocity[0][2];
    const double slip_before = def->body[0].velocity[0] - radius * def->body[0].spin[1];
    const double slip_after = r->velocity[0][0] - radius * r->spin[0][1];
    printf(
        "{\"part\": \"%s\", \"case\": \"%s\", \"x\": %.9g, \"v_t\": %.9g, \"v_t_after\": %.9g, \"spin_after\": %.9g, "
        "\"slip\": %.9g, \"slip_after\": %.9g, \"v_n\": %.9g, \"v_n_after\": %.9g, \"mu\": %g, \"radius\": %g}\n",
        part, name, x, def->body[0].velocity[0], r->velocity[0][0], r->spin[0][1], slip_before, slip_after,
        -def->body[0].velocity[2], v_n, def->friction, radius);
}

static void test_4(void)
{
    const solid solids[2] = {al_oxide, al_alloy};
    for (int k = 0; k < 2; ++k)
        for (int degrees = 5; degrees <= 85; degrees += 5)
        {
            impact_def def = define(solids[k], 0.0025, 0);
            def.body[0].velocity[0] = 3.9 * sin(degrees * M_PI / 180);
            def.body[0].velocity[2] = -3.9 * cos(degrees * M_PI / 180);
            def.friction = 0.092;
            def.restitution = 0.98;
            def.time_step = hertz_contact_time(&def) / 1000;
            const impact_result r = impact_run(&def);
            put_oblique("test_4", solids[k].name, degrees, &def, &r);
            const double closed_form[3][2] = {{0.7829, 544.2}, {0.8948, 355.2}, {0.9679, 123.4}};
            if (k > 0 || degrees % 20 != 0 || degrees < 40) continue;
            char name[40];
            snprintf(name, sizeof name, "%s, %d degrees", solids[k].name, degrees);
            put_row("4", name, "e_t", closed_form[degrees / 20 - 2][0], r.velocity[0][0] / def.body[0].velocity[0],
                    "closed form");
            put_row("4", name, "spin' [rad/s]", closed_form[degrees / 20 - 2][1], r.spin[0][1], "closed form");
        }
}

static void tests_5_to_8(void)
{
    const solid fifth[2] = {steel, polyethylene}, sixth[2] = {al_alloy, nylon}, seventh[2] = {al_alloy, copper};
    for (int k = 0; k < 2; ++k)
    {
        for (int n = 1; n <= 24; ++n)
        {
            impact_def def = define(fifth[k], 1e-5, 5);
            def.friction = 0.3;
            def.body[0].velocity[0] = 5 * 0.3 * 0.5 * n;
            def.time_step = hertz_contact_time(&def) / 1000;
            const impact_result r = impact_run(&def);
            put_oblique("test_5", fifth[k].name, 0.5 * n, &def, &r);
            if (n == 16) put_sliding("5", fifth[k].name, &def, &r);
        }
        for (int n = 1; n <= 24; ++n)
            for (int partner = 0; partner < 2; ++partner)
            {
                impact_def def = define(sixth[k], 0.1, 0.2);
                if (partner > 0) def.body[1].radius = 0.5;
                def.friction = 0.4;
                def.restitution = 0.5;
                def.body[0].spin[1] = -0.2 * 0.25 * n / 0.1;
                def.time_step = hertz_contact_time(&def) / 1000;
                const impact_result r = impact_run(&def);
                if (partner == 0) put_oblique("test_6", sixth[k].name, 0.25 * n, &def, &r);
                if (n == 16) put_sliding(partner > 0 ? "8" : "6", sixth[k].name, &def, &r);
            }
        impact_def def = define(seventh[k], 0.1, 0.2);
        def.body[1] = (impact_body){0.1, {0, 0, 0.2}, {0, 7, 0}};
        def.body[0].spin[1] = -7;
        def.friction = 0.4;
        def.restitution = 0.5;
        def.time_step = hertz_contact_time(&def) / 1000;
        const impact_result r = impact_run(&def);
        put_row("7", seventh[k].name, "v_t' [m/s]", 0, r.velocity[0][0], "closed form");
        put_row("7", seventh[k].name, "spin' [rad/s]", -7, r.spin[0][1], "closed form");
    }
}

/// Force over indentation of a glass ball on a plane, by law and restitution.
static void force_over_indentation(void)
{
    const double values[] = {1, 0.7, 0.4};
    static double history[4000][2];
    for (int linear = 0; linear < 2; ++linear)
        for (int k = 0; k < 3; ++k)
        {
            impact_def def = define(glass, 0.01, 1);
            char law[100];
            // as stiff as Hertz at its deepest point
            const double stiffness = hertz_largest_force(&def) / hertz_deepest(&def);
            snprintf(law, sizeof law, ", model: linear_spring, normal_stiffness: %.9g", stiffness);
            def.law = linear > 0 ? law : "";
            def.restitution = values[k];
            def.time_step = hertz_contact_time(&def) / 400;
            def.history = history;
            def.max_history = 4000;
            const impact_result r = impact_run(&def);
            printf("{\"part\": \"force\", \"law\": \"%s\", \"e\": %g, \"modulus\": %.9g, \"radius\": 0.01, "
                   "\"stiffness\": %.9g, "
                   "\"points\": [",
                   linear > 0 ? "linear_spring" : "hertz_mindlin", values[k], impact_modulus(&def), stiffness);
            for (int n = 0; n < r.num_history; n += 2)
                printf("%s[%.6g, %.6g]", n > 0 ? ", " : "", history[n][0], history[n][1]);
            printf("]}\n");
        }
}

/// Tops of the bounces of a ball dropped on a plane.
static void drop(double restitution)
{
    const double radius = 0.01, height = 0.1;
    char text[1000];
    snprintf(text, sizeof text,
             "time: {end: 3, step: 1e-5}\n"
             "materials: [{name: glass, density: 2500, youngs_modulus: 1e8, poisson_ratio: 0.25}]\n"
             "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.3, restitution_coefficient: %g}]\n"
             "shapes: [{name: ball, source: sphere, size: 0.02}, {name: plate, source: box, size: [1, 1, 0.1]}]\n"
             "particles: [{name: one, shape: ball, material: glass, bodies: [{position: [0, 0, %g]}]}]\n"
             "walls: [{name: floor, shape: plate, material: glass, position: [0, 0, -0.05]}]\n",
             restitution, height + radius);
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return;
    double top = height, last = 1;
    int num = 0;
    while (num <= 8 && scree_simulation_time(run.simulation) < 3)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        const double above = (double)run.simulation->particles.position[0].z - radius;
        if (above < 0 && last >= 0)
        {
            printf("{\"part\": \"drop\", \"e\": %g, \"bounce\": %d, \"height\": %.9g}\n", restitution, num++, top);
            top = 0;
        }
        top = fmax(top, above);
        last = above;
    }
    scene_run_end(&run);
}

int main(void)
{
    tests_1_to_3();
    test_4();
    tests_5_to_8();
    force_over_indentation();
    drop(0.5);
    drop(0.66);
    drop(0.9);
    return scree_test_num_failed > 0;
}
