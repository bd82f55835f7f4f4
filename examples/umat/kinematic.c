/* UMAT in C: von Mises plasticity with linear isotropic and linear kinematic hardening, for small strains.

   PROPS: E, nu, yield stress, isotropic hardening H, kinematic hardening C (back stress over plastic strain).
   STATEV: back stress (6, in the order of STRESS), accumulated plastic strain.

   gcc -O2 -shared -fPIC -o kinematic.so kinematic.c -lm */
#include <math.h>

static double mises(const double *s) {
    const double d = (s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) + (s[2] - s[0]) * (s[2] - s[0]);
    return sqrt(0.5 * d + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *jstep, const int *kinc) {
    const double E = props[0], nu = props[1], H = props[3], C = props[4];
    const double mu = 0.5 * E / (1.0 + nu), kappa = E / (3.0 * (1.0 - 2.0 * nu));
    double *back = statev, *eqps = statev + 6;
    double xi[6], flow[6];

    /* Elastic trial stress. DDSDDE is stored by columns. */
    for (int i = 0; i < 36; ++i) ddsdde[i] = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) ddsdde[6 * j + i] = kappa + 2.0 * mu * ((i == j) - 1.0 / 3.0);
        ddsdde[7 * (i + 3)] = mu;
    }
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) stress[i] += ddsdde[6 * j + i] * dstran[j];

    for (int i = 0; i < 6; ++i) xi[i] = stress[i] - back[i];
    const double mean = (xi[0] + xi[1] + xi[2]) / 3.0;
    for (int i = 0; i < 3; ++i) xi[i] -= mean;
    const double q = mises(xi), yield = props[2] + H * *eqps;
    if (q > yield * (1.0 + 1e-10)) {
        const double dp = (q - yield) / (3.0 * mu + C + H), share = 3.0 * mu * dp / q;
        double work = 0.0;
        for (int i = 0; i < 6; ++i) {
            flow[i] = 1.5 * xi[i] / q; /* by stress; engineering shears have twice that */
            work += 0.5 * (i < 3 ? 1.0 : 2.0) * back[i] * flow[i];
            stress[i] -= share * xi[i];
            back[i] += C * dp * xi[i] / q;
            work += 0.5 * (i < 3 ? 1.0 : 2.0) * back[i] * flow[i];
        }
        const double along = 4.0 * mu * mu * (dp / q - 1.0 / (3.0 * mu + C + H));
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) ddsdde[6 * j + i] -= 2.0 * mu * share * ((i == j) - 1.0 / 3.0);
            ddsdde[7 * (i + 3)] -= mu * share;
        }
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) ddsdde[6 * j + i] += along * flow[i] * flow[j];
        *spd += dp * (yield + 0.5 * H * dp + work);
        *eqps += dp;
    }
    const double pressure = (stress[0] + stress[1] + stress[2]) / 3.0, size = mises(stress);
    *sse = 0.5 * pressure * pressure / kappa + size * size / (6.0 * mu);
}
