! UMAT in Fortran: von Mises plasticity with linear isotropic and linear kinematic hardening, for small strains.
!
! PROPS: E, nu, yield stress, isotropic hardening H, kinematic hardening C (back stress over plastic strain).
! STATEV: back stress (6, in the order of STRESS), accumulated plastic strain.
!
! gfortran -O2 -shared -fPIC -o kinematic.so kinematic.f90
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc, i, j
  double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens)
  double precision :: drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1)
  double precision :: dpred(1), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
  double precision :: mu, kappa, H, C, xi(6), flow(6), weight(6), q, yield, dp, share, along

  mu = 0.5d0 * props(1) / (1.0d0 + props(2))
  kappa = props(1) / (3.0d0 * (1.0d0 - 2.0d0 * props(2)))
  H = props(4)
  C = props(5)
  weight = [1.0d0, 1.0d0, 1.0d0, 2.0d0, 2.0d0, 2.0d0]

  ! Elastic trial stress.
  ddsdde = 0.0d0
  ddsdde(1:3, 1:3) = kappa - 2.0d0 / 3.0d0 * mu
  do i = 1, 3
    ddsdde(i, i) = kappa + 4.0d0 / 3.0d0 * mu
    ddsdde(i + 3, i + 3) = mu
  end do
  stress = stress + matmul(ddsdde, dstran)

  xi = stress - statev(1:6)
  xi(1:3) = xi(1:3) - sum(xi(1:3)) / 3.0d0
  q = sqrt(1.5d0 * sum(weight * xi**2))
  yield = props(3) + H * statev(7)
  if (q > yield * (1.0d0 + 1.0d-10)) then
    dp = (q - yield) / (3.0d0 * mu + C + H)
    share = 3.0d0 * mu * dp / q
    flow = 1.5d0 * xi / q
    stress = stress - share * xi
    spd = spd + dp * (yield + 0.5d0 * H * dp + sum(weight * flow * (statev(1:6) + 0.5d0 * C * dp * xi / q)))
    statev(1:6) = statev(1:6) + C * dp * xi / q
    statev(7) = statev(7) + dp
    along = 4.0d0 * mu**2 * (dp / q - 1.0d0 / (3.0d0 * mu + C + H))
    ddsdde(1:3, 1:3) = ddsdde(1:3, 1:3) + 2.0d0 / 3.0d0 * mu * share
    do i = 1, 3
      ddsdde(i, i) = ddsdde(i, i) - 2.0d0 * mu * share
      ddsdde(i + 3, i + 3) = ddsdde(i + 3, i + 3) - mu * share
    end do
    do j = 1, 6
      ddsdde(:, j) = ddsdde(:, j) + along * flow * flow(j)
    end do
  end if
  xi = stress
  xi(1:3) = xi(1:3) - sum(stress(1:3)) / 3.0d0
  sse = 0.5d0 * (sum(stress(1:3)) / 3.0d0)**2 / kappa + 0.25d0 * sum(weight * xi**2) / mu
end subroutine umat
